//! The `sunbake` command as its users meet it: a process with arguments, two streams and an exit code.
#![allow(clippy::unwrap_used, missing_docs)]

mod tools;

mod a_bake_that_stops_leaves_the_old_set_or_none;
mod ambient_light_is_baked;
mod any_day_at_any_place_bakes;
mod cost_reports_are_written;
mod effects_that_are_off_cost_nothing;
mod errors_are_one_line;
mod help_streams_and_exit_codes;
mod lamps_are_baked;
mod lanes_and_loss_maps_are_written;
mod odd_scenes_are_told_of;
