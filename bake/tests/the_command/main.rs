//! The `sunbake` command as its users meet it: a process with arguments, two streams and an exit code.
#![allow(clippy::unwrap_used, missing_docs)]

mod tools;

mod a_bake_that_stops_leaves_the_old_set_or_none;
mod ambient_light_is_baked_as_told;
mod any_day_at_any_place_bakes;
mod cost_is_measured_as_told;
mod it_minds_its_manners;
mod lamps_are_baked_as_told;
mod lanes_and_loss_maps_are_written_as_told;
mod what_is_off_costs_nothing;
mod what_is_wrong_is_said_in_one_line;
