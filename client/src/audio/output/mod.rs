//! The sound device: what the platform has.

#[cfg(any(target_os = "macos", target_os = "windows"))]
mod device;
#[cfg(target_os = "linux")]
mod libraries;
#[cfg(target_os = "linux")]
mod linux;

#[cfg(any(target_os = "macos", target_os = "windows"))]
pub(super) use device::play;
#[cfg(target_os = "linux")]
pub(super) use linux::play;

/// Nobody has written an output for this platform.
#[cfg(not(any(target_os = "linux", target_os = "macos", target_os = "windows")))]
pub(super) fn play(_: super::engine::Engine) {
    tracing::warn!("no sound: not on this platform");
}
