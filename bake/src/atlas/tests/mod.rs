//! Claims about atlases, checked by brute force that shares no code with what it checks.

mod claims;
mod hard_cases;
mod scenes;
