//! Reports, and `scene.glb`, in a real browser. The harness is not the usual one: without Chromium every test is listed
//! as ignored, and counted as skipped.

mod a_stock_viewer_shows_the_same;
mod compare_reports_work;
mod reports_work;

fn main() {
    let trials = [reports_work::trials(), compare_reports_work::trials(), a_stock_viewer_shows_the_same::trials()];
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), trials.into_iter().flatten().collect()).exit();
}
