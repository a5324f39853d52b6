//! Reports: what was measured, as one HTML page and one JSON file that need nothing else, no network least of all.
//!
//! `sunbake cost` and `sunplay compare` write theirs by it, so that both read alike. [`page`](page()) makes the document,
//! [`Table`] and [`plot`] what stands in it, [`folder`] the folder, [`Machine`] says where the times were taken.

pub mod folder;
mod machine;
mod number;
mod page;
pub mod plot;
mod table;

pub use machine::Machine;
pub use number::{plain, whole, with_unit};
pub use page::{escape, page};
pub use table::{Cell, Column, Row, Table};
