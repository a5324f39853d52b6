//! Hard cases I1 to I7, and what of B13 to B15 is about finding times: every engine against brute force in `f64`, and
//! against closed forms.
//!
//! `SUNBAKE_CASES=1000000 tests/run --release -E 'test(random_triangles)'` tries a million random scenes.

mod awkward_paths;
mod awkward_triangles;
mod leaves_and_fences;
mod random_scenes;
mod smooth_surfaces;
mod spheres_and_needles;
