//! Error against time, on logarithmic axes, as an SVG.

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// A scene's name, and for each rival the time of a texel in microseconds with the error that it left.
type Scene = (String, [Vec<(f64, f64)>; 2]);

/// Draws one panel a scene.
pub fn draw(file: &Path, scenes: &[Scene]) -> Result<(), Box<dyn Error>> {
    let columns = scenes.len().min(2);
    let rows = scenes.len().div_ceil(columns);
    let root = SVGBackend::new(file, (440 * columns as u32, 300 * rows as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    for (panel, (name, [ours, plain])) in root.split_evenly((rows, columns)).iter().zip(scenes) {
        let mut chart = ChartBuilder::on(panel)
            .margin(12)
            .caption(name, ("sans-serif", 17))
            .x_label_area_size(38)
            .y_label_area_size(58)
            .build_cartesian_2d((0.5..3000.0f64).log_scale(), (2e-4..0.25f64).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc("microseconds a texel, one thread")
            .y_desc("rms error of ambient visibility")
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("{y}"))
            .draw()?;
        for (curve, label, color) in
            [(plain, "plain random", RGBColor(150, 150, 150)), (ours, "sunbake", RGBColor(216, 96, 32))]
        {
            chart
                .draw_series(LineSeries::new(curve.iter().copied(), color.stroke_width(2)).point_size(3))?
                .label(label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        }
        chart.configure_series_labels().position(SeriesLabelPosition::LowerLeft).background_style(WHITE).draw()?;
    }
    root.present()?;
    Ok(())
}
