//! Numbers formatted for reading.

/// A number with this many significant digits, in plain notation: `0.0123`, `4.5`, `12,300`. Very small and very large
/// numbers, and those that are not finite, are in scientific notation.
pub fn plain(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs().log10().floor();
    if !value.is_finite() || !(-7.0..15.0).contains(&magnitude) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = digits as i32 - 1 - magnitude as i32;
    if decimals > 0 {
        return format!("{value:.*}", decimals as usize);
    }
    // Whole numbers are never rounded below the unit: it would make 1,234 files 1,230.
    grouped(value.round())
}

/// A count with thousands separated: `12,345`.
pub fn whole(count: u64) -> String {
    grouped(count as f64)
}

/// A number with three significant digits and its unit; bytes and seconds in a suitable multiple.
pub fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "bytes" => bytes(value),
        "s" if value >= 120.0 => format!("{} min", plain(value / 60.0, 3)),
        _ => format!("{} {unit}", plain(value, 3)),
    }
}

fn bytes(value: f64) -> String {
    let [kib, mib, gib] = [10, 20, 30].map(|shift| value / f64::from(1 << shift));
    match value {
        ..1024.0 => format!("{} bytes", plain(value, 3)),
        _ if kib < 1024.0 => format!("{} KiB", plain(kib, 3)),
        _ if mib < 1024.0 => format!("{} MiB", plain(mib, 3)),
        _ => format!("{} GiB", plain(gib, 3)),
    }
}

/// A whole number with thousands separated.
fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut text = String::from(if value < 0.0 { "-" } else { "" });
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        let shown = [0.0, 0.012345, 4.5678, -12.34, 999.9, 1234.0, 1.5e6].map(|value| plain(value, 3));
        assert_eq!(shown, ["0", "0.0123", "4.57", "-12.3", "1,000", "1,234", "1,500,000"]);
        assert_eq!([1e-9, f64::NAN, f64::INFINITY].map(|value| plain(value, 2)), ["1.0e-9", "NaN", "inf"]);
    }

    #[test]
    fn counts_are_whole() {
        assert_eq!([0, 31, 1000, 2_504_390].map(whole), ["0", "31", "1,000", "2,504,390"]);
    }

    #[test]
    fn bytes_and_seconds_take_the_unit_that_suits() {
        let shown = [(12.0, "bytes"), (2048.0, "bytes"), (5e7, "bytes"), (5.0, "s"), (600.0, "s"), (0.5, "min")];
        let shown = shown.map(|(value, unit)| with_unit(value, unit));
        assert_eq!(shown, ["12.0 bytes", "2.00 KiB", "47.7 MiB", "5.00 s", "10.0 min", "0.500 min"]);
    }
}
