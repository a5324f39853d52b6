//! Keeps a line about `XDG_RUNTIME_DIR` off stderr where there is no desktop.
//!
//! Mesa's Vulkan layer that sorts devices looks for a Wayland display, and Wayland's library prints that the variable
//! is not set: in containers, over ssh, in CI. If it names a folder that does not exist, nothing is printed. A process
//! cannot safely change its own environment, so it replaces itself by a new one of the same program.

/// Starts the program again with the variable set, if it is not; returns if there is nothing to do or it failed.
#[cfg(target_os = "linux")]
pub fn answer_that_there_is_none() {
    use std::os::unix::process::CommandExt;
    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    let mut arguments = std::env::args_os();
    let (Some(name), Ok(program)) = (arguments.next(), std::env::current_exe()) else { return };
    if std::env::var_os(VARIABLE).is_none() {
        // Returns only if it fails; the line is printed then.
        let _ = std::process::Command::new(program).arg0(name).args(arguments).env(VARIABLE, "/nonexistent").exec();
    }
}

/// Nothing to do: only Linux has that layer.
#[cfg(not(target_os = "linux"))]
pub fn answer_that_there_is_none() {}
