//! Reports: measurements as one HTML page and one JSON file. Both are self-contained and need no network.
//!
//! `sunbake cost` and `sunplay compare` both use it, so that their reports look alike. [`page`](page()) makes the
//! document, [`Table`] and [`plot`] its contents, [`folder`] the folder; [`Machine`] describes the machine on which
//! times were measured.

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
