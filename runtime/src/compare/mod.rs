//! Comparing techniques: all draw the same frames, and each picture is compared with a reference's.
//!
//! [`run`] is one call from [`CompareSettings`] to [`Compared`], a report and its pictures:
//!
//! 1. `inputs` reads the set, or bakes the scene once for each count of lanes that some technique plays back.
//! 2. `viewpoints` takes the cameras and times that are asked for, or finds cameras that see many shadow edges
//!    (`shadow_edge_cameras`).
//! 3. [`Comparison`] draws every frame with every technique and scores the pictures (`score`).
//! 4. [`report`] is what is written: JSON by a schema, and a page. [`sheet`] is one picture of it. [`Limit`] checks the
//!    most that was allowed.
//!
//! `agreement`, `mask` and `acne_and_leaks` compare two pictures in finer ways, for tests and measurements.

mod acne_and_leaks;
mod agreement;
mod comparison;
mod error;
mod inputs;
mod limits;
mod mask;
pub mod report;
mod report_notes;
mod run;
mod score;
mod settings;
mod shadow_edge_cameras;
mod sheet;
mod technique;
mod viewpoints;

pub use acne_and_leaks::Defects;
pub use agreement::{Agreement, color_difference, edges, mean, visibility_difference};
pub use comparison::{Comparison, LitFrame, Outcome, SetOnDisk, lit_picture_of, visibility_codes};
pub use error::CompareError;
pub use limits::{Limit, Limited};
pub use mask::{FINE_PX, MaskAgreement};
pub use run::{Compared, run};
pub use score::{Score, Tally, luma, structural_similarity};
pub use settings::{CompareProgress, CompareSettings, CompareSource};
pub use shadow_edge_cameras::{NamedCamera, shadow_edge_cameras};
pub use sheet::{BestPair, sheet};
pub use technique::{Playback, TechniqueNameError, TechniqueSpec, selected};
