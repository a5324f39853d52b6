//! A plot drawn with plotters, on white, also in a dark page: the colours are chosen for white.

use super::axis::{AxisPosition, Scale};
use super::labels::{self, LabelAnchor};
use super::{Plot, Point, SIZE, Series};
use crate::report::{escape, plain};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Free pixels around the frame: left, top, right, bottom.
const MARGIN: [i32; 4] = [86, 68, 26, 82];
const INK: RGBColor = RGBColor(35, 33, 29);
const SOFT: RGBColor = RGBColor(106, 101, 92);
const GRID: RGBColor = RGBColor(232, 228, 219);
const MARK: RGBColor = RGBColor(180, 80, 30);
/// Colours that are also distinct with red-green colour blindness (Okabe and Ito, 2008), darkest first.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(140, 110, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];
/// Letters of names and of numbers beside axes, in pixels.
const SMALL: f64 = 12.5;
/// What plotters divides a size by before it writes it into a file.
const SHRINK: f64 = 1.24;

/// The scales of both axes, in pixels of the picture.
pub(super) struct Frame {
    pub x: Scale,
    pub y: Scale,
}

/// Pixels from the frame's left to its right.
pub(super) fn across() -> [f64; 2] {
    [f64::from(MARGIN[0]), f64::from(SIZE[0] as i32 - MARGIN[2])]
}

/// Pixels from the frame's foot to its head.
pub(super) fn upwards() -> [f64; 2] {
    [f64::from(SIZE[1] as i32 - MARGIN[3]), f64::from(MARGIN[1])]
}

/// Where a point lies in the picture, in pixels; hollow where a coordinate stands for zero or less.
#[derive(Clone, Copy)]
struct Spot {
    at: (i32, i32),
    is_hollow: bool,
}

impl Frame {
    fn spot(&self, point: &Point) -> Option<Spot> {
        let (x, y): (AxisPosition, AxisPosition) = (self.x.place(point.x)?, self.y.place(point.y)?);
        Some(Spot { at: (x.pixel.round() as i32, y.pixel.round() as i32), is_hollow: x.is_zero || y.is_zero })
    }
}

/// The plot as an SVG element; empty if plotters fails, which happens only when writing files.
pub(super) fn svg(plot: &Plot, frame: &Frame) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (SIZE[0], SIZE[1])).into_drawing_area();
        let _ = draw(plot, frame, &area);
    }
    finished(&text, plot, frame)
}

fn draw(plot: &Plot, frame: &Frame, area: &Area) -> Drawn {
    area.fill(&WHITE)?;
    axes(plot, frame, area)?;
    for (k, series) in plot.series.iter().enumerate() {
        let color = COLORS[k % COLORS.len()];
        line(series, frame, area, color)?;
        for spot in series.points.iter().filter_map(|point| frame.spot(point)) {
            dot(spot, area, color)?;
        }
    }
    if let Some(spot) = plot.mark.as_ref().and_then(|mark| frame.spot(mark)) {
        area.draw(&Circle::new(spot.at, 10, MARK.stroke_width(2)))?;
    }
    names(plot, frame, area)?;
    legend(plot, area)?;
    write(area, &notes(plot, frame), (MARGIN[0], SIZE[1] as i32 - 12), SMALL, &SOFT, HPos::Left)?;
    area.present()?;
    Ok(())
}

fn axes(plot: &Plot, frame: &Frame, area: &Area) -> Drawn {
    let ([left, right], [foot, head]) = (across().map(|x| x as i32), upwards().map(|y| y as i32));
    for (pixel, text) in frame.x.ticks() {
        let x = pixel.round() as i32;
        area.draw(&PathElement::new([(x, foot), (x, head)], GRID))?;
        write(area, &text, (x, foot + 14), SMALL, &SOFT, HPos::Center)?;
    }
    for (pixel, text) in frame.y.ticks() {
        let y = pixel.round() as i32;
        area.draw(&PathElement::new([(left, y), (right, y)], GRID))?;
        write(area, &text, (left - 8, y), SMALL, &SOFT, HPos::Right)?;
    }
    area.draw(&PathElement::new([(left, head), (left, foot), (right, foot)], SOFT))?;
    write(area, &plot.title, (left, 18), 16.5, &INK, HPos::Left)?;
    write(area, &plot.x.label, ((left + right) / 2, foot + 36), 13.5, &INK, HPos::Center)?;
    let upright = ("sans-serif", 13.5 * SHRINK).into_font().transform(FontTransform::Rotate270).color(&INK);
    area.draw(&Text::new(
        plot.y.label.clone(),
        (20, (foot + head) / 2),
        upright.pos(Pos::new(HPos::Center, VPos::Center)),
    ))?;
    Ok(())
}

/// Joins neighbours that both lie on the plot.
fn line(series: &Series, frame: &Frame, area: &Area, color: RGBColor) -> Drawn {
    let spots: Vec<Option<Spot>> = series.points.iter().map(|point| frame.spot(point)).collect();
    for pair in spots.windows(2).filter(|_| series.is_joined) {
        if let [Some(a), Some(b)] = pair {
            area.draw(&PathElement::new([a.at, b.at], color.mix(0.55).stroke_width(2)))?;
        }
    }
    Ok(())
}

fn dot(spot: Spot, area: &Area, color: RGBColor) -> Drawn {
    if spot.is_hollow {
        area.draw(&Circle::new(spot.at, 5, WHITE.filled()))?;
        area.draw(&Circle::new(spot.at, 5, color.stroke_width(2)))?;
    } else {
        area.draw(&Circle::new(spot.at, 5, color.filled()))?;
    }
    Ok(())
}

/// Names beside their points; the mark's first, since it must find a place.
fn names(plot: &Plot, frame: &Frame, area: &Area) -> Drawn {
    let of_series = plot.series.iter().enumerate();
    let named =
        of_series.flat_map(|(k, series)| series.points.iter().map(move |point| (point, COLORS[k % COLORS.len()])));
    let all = plot.mark.iter().map(|mark| (mark, MARK)).chain(named);
    let placed: Vec<_> = all.filter_map(|(point, color)| Some((frame.spot(point)?, point, color))).collect();
    let points: Vec<_> = placed
        .iter()
        .map(|(spot, point, _)| ([f64::from(spot.at.0), f64::from(spot.at.1)], point.label.as_str()))
        .collect();
    let ([left, right], [foot, head]) = (across(), upwards());
    let lines: Vec<_> =
        plot.series.iter().filter(|series| series.is_joined).flat_map(|series| along(series, frame)).collect();
    let anchors = labels::anchors(&points, &lines, SMALL, [left + 2.0, head - 14.0, right + 22.0, foot - 2.0]);
    for ((_, point, color), anchor) in placed.iter().zip(anchors) {
        let Some(LabelAnchor { left, middle }) = anchor else { continue };
        write(area, &point.label, (left.round() as i32, middle.round() as i32), SMALL, &darker(*color), HPos::Left)?;
    }
    Ok(())
}

/// Pixels every few along a line.
fn along(series: &Series, frame: &Frame) -> Vec<[f64; 2]> {
    let spots: Vec<(i32, i32)> = series.points.iter().filter_map(|point| Some(frame.spot(point)?.at)).collect();
    let between = |pair: &[(i32, i32)]| {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]].map(|(x, y)| (f64::from(x), f64::from(y)));
        let steps = ((x1 - x0).hypot(y1 - y0) / 6.0).ceil().max(1.0) as usize;
        (0..steps).map(move |k| k as f64 / steps as f64).map(move |s| [x0 + s * (x1 - x0), y0 + s * (y1 - y0)])
    };
    spots.windows(2).flat_map(between).collect()
}

/// Small letters need more contrast than dots.
fn darker(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let scaled = |c: u8| (f64::from(c) * 0.72) as u8;
    RGBColor(scaled(r), scaled(g), scaled(b))
}

/// The legend, in a row below the title; none for a single series.
fn legend(plot: &Plot, area: &Area) -> Drawn {
    let mut x = MARGIN[0];
    for (k, series) in plot.series.iter().enumerate().filter(|_| plot.series.len() > 1) {
        area.draw(&Circle::new((x + 5, 42), 5, COLORS[k % COLORS.len()].filled()))?;
        write(area, &series.name, (x + 15, 42), SMALL, &INK, HPos::Left)?;
        x += 32 + labels::width(&series.name, SMALL) as i32;
    }
    Ok(())
}

fn write(area: &Area, text: &str, at: (i32, i32), size: f64, color: &RGBColor, side: HPos) -> Drawn {
    let style = ("sans-serif", size * SHRINK).into_font().color(color).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style))?;
    Ok(())
}

/// A note about points that cannot be placed.
fn notes(plot: &Plot, frame: &Frame) -> String {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let mut notes = Vec::new();
    if points().filter_map(|point| frame.spot(point)).any(|spot| spot.is_hollow) {
        notes.push("hollow: zero, which a logarithmic axis has no place for".to_owned());
    }
    let lost: Vec<&str> =
        points().filter(|point| frame.spot(point).is_none()).map(|point| point.label.as_str()).collect();
    if !lost.is_empty() {
        notes.push(format!("not shown, since they have no number: {}", lost.join(", ")));
    }
    notes.join("; ")
}

/// Gives every point a tooltip with its name and numbers, and lets the page choose size and font.
fn finished(svg: &str, plot: &Plot, frame: &Frame) -> String {
    let tip = |point: &Point| {
        let Spot { at: (x, y), .. } = frame.spot(point)?;
        let text = format!(
            "{}\n{}: {}\n{}: {}",
            point.label,
            plot.x.label,
            plain(point.x, 4),
            plot.y.label,
            plain(point.y, 4)
        );
        Some(format!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"9\" fill-opacity=\"0\"><title>{}</title></circle>\n",
            escape(&text)
        ))
    };
    let tips: String = plot.series.iter().flat_map(|series| &series.points).filter_map(tip).collect();
    let body = svg.rfind("</svg>").map_or("", |end| &svg[..end]);
    let start = body.find("<svg").unwrap_or(0);
    let named = format!("<svg role=\"img\" aria-label=\"{}\" ", escape(&plot.title));
    let text = body[start..].replacen("<svg ", &named, 1);
    // Within HTML the name space goes without saying, and nothing then looks like an address.
    let text = text.replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    text.replace("font-family=\"sans-serif\"", "font-family=\"system-ui, sans-serif\"") + &tips + "</svg>\n"
}
