//! Whether a window can be opened. miniquad ends the process if one of its libraries or the display is missing, so
//! that is found out before.

/// Why no window can be opened; for a person to read.
///
/// # Errors
/// The first thing that is missing.
#[cfg(target_os = "linux")]
pub(crate) fn check() -> Result<(), String> {
    let display = std::env::var("DISPLAY").unwrap_or_default();
    if display.is_empty() {
        return Err("there is no display (DISPLAY is not set)".to_owned());
    }
    let place = linux::Place::of(&display).ok_or_else(|| format!("{display:?} in DISPLAY names no display"))?;
    place.reach().map_err(|error| format!("the display {display} cannot be reached ({error})"))?;
    match linux::missing_library() {
        Some(library) => Err(format!("no window can be opened without {library}")),
        None => Ok(()),
    }
}

/// Elsewhere the window system is part of the operating system.
#[cfg(not(target_os = "linux"))]
pub(crate) fn check() -> Result<(), String> {
    Ok(())
}

#[cfg(target_os = "linux")]
mod linux {
    use std::io;
    use std::net::{TcpStream, ToSocketAddrs};
    use std::os::linux::net::SocketAddrExt;
    use std::os::unix::net::{SocketAddr, UnixStream};
    use std::path::Path;
    use std::time::Duration;

    /// What miniquad loads: X11, its input extension, keyboard maps, OpenGL.
    const LIBRARIES: [&str; 4] = ["libX11.so.6", "libXi.so.6", "libxkbcommon.so.0", "libGL.so.1"];
    /// Display N of a host listens on this port + N.
    const FIRST_PORT: u16 = 6000;

    /// Where a display listens.
    #[derive(Debug, PartialEq, Eq)]
    pub(super) enum Place {
        /// On this machine, by number.
        Here(u16),
        /// On a host, by number.
        There(String, u16),
    }

    impl Place {
        /// From `[HOST]:NUMBER[.SCREEN]`.
        pub(super) fn of(display: &str) -> Option<Self> {
            let (host, rest) = display.rsplit_once(':')?;
            let number = rest.split('.').next()?.parse().ok()?;
            let is_here = host.is_empty() || host == "unix" || host.starts_with('/');
            Some(if is_here { Self::Here(number) } else { Self::There(host.to_owned(), number) })
        }

        pub(super) fn reach(&self) -> io::Result<()> {
            match self {
                Self::Here(number) => {
                    let path = format!("/tmp/.X11-unix/X{number}");
                    UnixStream::connect(&path)
                        .or_else(|_| UnixStream::connect_addr(&SocketAddr::from_abstract_name(path)?))
                        .map(drop)
                }
                Self::There(host, number) => {
                    let port = FIRST_PORT.checked_add(*number).ok_or(io::ErrorKind::InvalidInput)?;
                    let mut addresses = (host.as_str(), port).to_socket_addrs()?;
                    let address = addresses.next().ok_or(io::ErrorKind::NotFound)?;
                    TcpStream::connect_timeout(&address, Duration::from_secs(3)).map(drop)
                }
            }
        }
    }

    /// The first library that is neither in the loader's cache nor on its path. Where there is no such cache, nothing
    /// can be said.
    pub(super) fn missing_library() -> Option<&'static str> {
        let cache = std::fs::read("/etc/ld.so.cache").ok()?;
        let path = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
        let on_path = |name: &str| std::env::split_paths(&path).any(|folder| folder.join(name).exists());
        let usual =
            |name: &str| ["/lib", "/usr/lib", "/lib64", "/usr/lib64"].iter().any(|f| Path::new(f).join(name).exists());
        LIBRARIES.into_iter().find(|name| !lists(&cache, name) && !on_path(name) && !usual(name))
    }

    /// Whether the loader's cache has a library: it is a list of strings that end in a zero byte.
    fn lists(cache: &[u8], name: &str) -> bool {
        let entry = [name.as_bytes(), b"\0"].concat();
        cache.windows(entry.len()).any(|window| window == entry)
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn displays() {
            assert_eq!(Place::of(":0"), Some(Place::Here(0)));
            assert_eq!(Place::of("unix:78.1"), Some(Place::Here(78)));
            assert_eq!(Place::of("far:10.0"), Some(Place::There("far".to_owned(), 10)));
            for bad in ["", "far", ":", ":x", ":-1", ":99999"] {
                assert_eq!(Place::of(bad), None, "{bad}");
            }
            assert!(Place::Here(60_123).reach().is_err());
        }

        #[test]
        fn libraries() {
            assert!(lists(b"xx\0libX11.so.6\0/usr/lib", "libX11.so.6"));
            assert!(!lists(b"xx\0libX11.so.60\0", "libX11.so.6"));
        }
    }
}
