//! Plots of one number against another, as SVG within a page: points with names, joined or not.
//!
//! A logarithmic axis has no place for zero, and leaving points out would mislead. So points of zero or less are drawn
//! hollow in a band at the axis' lower end, marked 0. For points that are not numbers, the plot has a note that they
//! are missing.

mod axis;
mod draw;
mod labels;

use axis::Scale;

/// Points over two axes, drawn as SVG.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Title above the plot.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The series, in drawing order.
    pub series: Vec<Series>,
    /// A highlighted point, such as the knee of a curve.
    pub mark: Option<Point>,
}

/// An axis, with its label and its kind of scale.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Axis {
    /// Label with the unit.
    pub label: String,
    /// Whether equal steps are equal ratios.
    pub is_log: bool,
}

impl Axis {
    /// Equal steps are equal differences.
    pub fn linear(label: &str) -> Self {
        Self { label: label.into(), is_log: false }
    }

    /// Equal steps are equal ratios.
    pub fn log(label: &str) -> Self {
        Self { label: label.into(), is_log: true }
    }
}

/// Points of one colour.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend, which is left out where there is one series.
    pub name: String,
    /// Whether a line joins the points, in their order.
    pub is_joined: bool,
    /// The points, in the order in which a line joins them.
    pub points: Vec<Point>,
}

/// A pair of values with its label.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Point {
    /// Value on the horizontal axis; a point without a number is not drawn.
    pub x: f64,
    /// Value on the vertical axis; a point without a number is not drawn.
    pub y: f64,
    /// Its name, shown where there is space, and as a tooltip.
    pub label: String,
}

/// Size of a plot, in pixels; pages may show it smaller.
const SIZE: [u32; 2] = [660, 430];

/// The plot as an SVG element.
pub fn scatter(plot: &Plot) -> String {
    let points = || plot.series.iter().flat_map(|series| &series.points).chain(&plot.mark);
    let frame = draw::Frame {
        x: Scale::new(points().map(|p| p.x), plot.x.is_log, draw::across()),
        y: Scale::new(points().map(|p| p.y), plot.y.is_log, draw::upwards()),
    };
    draw::svg(plot, &frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64) -> Point {
        Point { x, y, label: format!("p{x}") }
    }

    fn plot(points: Vec<Point>, is_log: bool) -> Plot {
        let axis = |label: &str| Axis { label: label.into(), is_log };
        let series = vec![Series { name: "a < b".into(), is_joined: true, points }];
        Plot { title: "T & U".into(), x: axis("s"), y: axis("min"), series, mark: None }
    }

    #[test]
    fn a_plot_of_nothing_of_one_and_of_oddities_is_a_plot() {
        let odd = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 1e300, 5.0];
        for is_log in [false, true] {
            for points in [vec![], vec![point(3.0, 4.0)], odd.iter().map(|&x| point(x, x)).collect()] {
                let svg = scatter(&plot(points, is_log));
                assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{svg}");
                assert!(!svg.contains("NaN") || svg.contains("not shown"), "{svg}");
            }
        }
    }

    #[test]
    fn zero_on_a_logarithmic_axis_is_hollow_and_said_to_be_zero() {
        let svg = scatter(&plot(vec![point(1.0, 0.0), point(2.0, 3.0)], true));
        assert!(svg.contains("hollow"), "{svg}");
        assert!(!scatter(&plot(vec![point(1.0, 1.0)], true)).contains("hollow"));
    }

    #[test]
    fn what_is_no_number_is_said_to_be_missing() {
        let svg = scatter(&plot(vec![point(1.0, 1.0), Point { label: "lost".into(), ..point(f64::NAN, 1.0) }], true));
        assert!(svg.contains("not shown") && svg.contains("lost"), "{svg}");
    }

    #[test]
    fn every_point_can_be_asked_for_its_name() {
        let svg = scatter(&plot(vec![point(1.0, 1.0), Point { label: "<x>".into(), ..point(2.0, 1.0) }], true));
        assert!(svg.contains("<title>&lt;x&gt;"), "{svg}");
    }
}
