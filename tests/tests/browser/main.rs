//! Reports in a real browser. The harness is not the usual one: without Chromium every test is listed as ignored, and
//! counted as skipped.

mod compare_reports_work;
mod reports_work;

fn main() {
    let trials = [reports_work::trials(), compare_reports_work::trials()];
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), trials.into_iter().flatten().collect()).exit();
}
