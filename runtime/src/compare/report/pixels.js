// Pixels of the viewer: from the sun's visibility to colour codes for a canvas.
//
// Twins of `light/tone.rs`, `texture.rs` and `sheet/heat.rs`; a test compares them code by code. Pictures come as the RGBA
// bytes of decoded images. A picture of visibility is grey, so its first channel is read: 0 is shade, 255 is full sun.

const EXPOSURE = 0.62;
const LUMINANCE = [0.2126, 0.7152, 0.0722];

function srgbFromLinear(x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}

/** sRGB codes of display-linear numbers from 0 to 1, accurate to one code. */
const SRGB_STEPS = 16384;
const SRGB_CODES = Uint8Array.from({ length: SRGB_STEPS + 1 }, (_, i) => Math.round(255 * srgbFromLinear(i / SRGB_STEPS)));

function codeFromLight(x) {
  const display = (x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14);
  return SRGB_CODES[Math.round(SRGB_STEPS * Math.min(display, 1))];
}

/** Writes the codes of exposed light at `at`. */
function putLight(codes, at, r, g, b) {
  const bright = r * LUMINANCE[0] + g * LUMINANCE[1] + b * LUMINANCE[2];
  const whiter = bright / (bright + 6);
  codes[at] = codeFromLight(r + (bright - r) * whiter);
  codes[at + 1] = codeFromLight(g + (bright - g) * whiter);
  codes[at + 2] = codeFromLight(b + (bright - b) * whiter);
  codes[at + 3] = 255;
}

/**
 * The scene as the sun lights it. `dark` and `open` are the scene with the sun hidden and with the sun seen everywhere,
 * as square roots of light: `light = scale * (code / 255)^2`.
 */
function litPicture({ dark, open, scale }, seen) {
  const light = Float32Array.from({ length: 256 }, (_, code) => EXPOSURE * scale * (code / 255) ** 2);
  const mixed = (i, share) => light[dark[i]] + share * (light[open[i]] - light[dark[i]]);
  const codes = new Uint8ClampedArray(seen.length);
  for (let i = 0; i < codes.length; i += 4) {
    const share = seen[i] / 255;
    putLight(codes, i, mixed(i, share), mixed(i + 1, share), mixed(i + 2, share));
  }
  return codes;
}

/** sRGB stops at even steps. Brightness increases throughout, so that a map can be read in grey as well. */
const HEAT_STOPS = [[16, 14, 22], [72, 24, 102], [158, 40, 100], [226, 88, 50], [250, 170, 52], [252, 250, 190]];

function heat(share) {
  const place = Math.min(Math.max(share, 0), 1) * (HEAT_STOPS.length - 1);
  const low = Math.min(Math.floor(place), HEAT_STOPS.length - 2);
  return HEAT_STOPS[low].map((code, k) => Math.round(code + (HEAT_STOPS[low + 1][k] - code) * (place - low)));
}

/** The difference of two pictures of visibility. The sRGB curve brightens small differences. */
function heatPicture(a, b, gain) {
  const colors = Array.from({ length: 256 }, (_, step) => heat(srgbFromLinear(Math.min((gain * step) / 255, 1))));
  const codes = new Uint8ClampedArray(a.length);
  for (let i = 0; i < codes.length; i += 4) {
    const color = colors[Math.abs(a[i] - b[i])];
    codes[i] = color[0];
    codes[i + 1] = color[1];
    codes[i + 2] = color[2];
    codes[i + 3] = a[i + 3];
  }
  return codes;
}

/** The square of pixels around one, `2 * reach + 1` wide; clear beyond the picture's edge. */
function around(codes, [width, height], [column, row], reach) {
  const edge = 2 * reach + 1;
  const square = new Uint8ClampedArray(edge * edge * 4);
  for (let i = 0; i < edge * edge; i++) {
    const [x, y] = [column - reach + (i % edge), row - reach + Math.floor(i / edge)];
    if (x < 0 || y < 0 || x >= width || y >= height) continue;
    const from = (y * width + x) * 4;
    square.set(codes.subarray(from, from + 4), i * 4);
  }
  return square;
}
