//! Claims about atlases, checked by brute force that shares no code with what it checks.

mod check;
mod claims;
mod files;
mod hard_cases;
mod scenes;
