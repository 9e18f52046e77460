//! The C functions of libpulse-simple and libasound, found at run time. All of the program's `unsafe` is in here; what is
//! outside sees two devices that can be opened and written to.
#![allow(unsafe_code, reason = "functions of C libraries can be called in no other way")]

use std::ffi::{CStr, c_char, c_int, c_long, c_uint, c_ulong, c_void};
use std::ptr::{null, null_mut};

use libloading::Library;

use super::linux::{OutputError, STORE_MS};

const CHANNELS: u8 = 2;
const FRAME_BYTES: u32 = 2 * CHANNELS as u32;
const LITTLE_ENDIAN: bool = cfg!(target_endian = "little");

/// `pa_sample_spec`.
#[repr(C)]
struct SampleSpec {
    format: c_int,
    rate: u32,
    channels: u8,
}

/// `pa_buffer_attr`, in bytes; `u32::MAX` leaves a field to the server.
#[repr(C)]
struct BufferAttributes {
    most: u32,
    target: u32,
    before_start: u32,
    least_request: u32,
    fragment: u32,
}

type PulseNew = unsafe extern "C" fn(
    server: *const c_char,
    name: *const c_char,
    direction: c_int,
    device: *const c_char,
    stream: *const c_char,
    spec: *const SampleSpec,
    map: *const c_void,
    attributes: *const BufferAttributes,
    error: *mut c_int,
) -> *mut c_void;
type PulseWrite = unsafe extern "C" fn(*mut c_void, *const c_void, usize, *mut c_int) -> c_int;
type PulseFree = unsafe extern "C" fn(*mut c_void);
type ErrorText = unsafe extern "C" fn(c_int) -> *const c_char;

/// A stream to a PulseAudio server.
pub(super) struct Pulse {
    stream: *mut c_void,
    write: PulseWrite,
    free: PulseFree,
    text: ErrorText,
}

impl Pulse {
    /// Finds the library and connects to the server. May wait for as long as a server takes.
    pub(super) fn open(rate: u32) -> Result<Self, OutputError> {
        const PLAYBACK: c_int = 1;
        const S16LE: c_int = 3;
        const S16BE: c_int = 4;
        let library = load("libpulse-simple.so.0")?;
        // SAFETY: these are the functions' types as pulse/simple.h and pulse/error.h of version 0 of the library declare them.
        let (new, write, free, text) = unsafe {
            (
                *library.get::<PulseNew>(c"pa_simple_new")?,
                *library.get::<PulseWrite>(c"pa_simple_write")?,
                *library.get::<PulseFree>(c"pa_simple_free")?,
                *library.get::<ErrorText>(c"pa_strerror")?,
            )
        };
        let format = if LITTLE_ENDIAN { S16LE } else { S16BE };
        let spec = SampleSpec { format, rate, channels: CHANNELS };
        let target = rate * STORE_MS / 1000 * FRAME_BYTES;
        let attributes = BufferAttributes {
            most: u32::MAX,
            target,
            before_start: u32::MAX,
            least_request: u32::MAX,
            fragment: u32::MAX,
        };
        let mut error = 0;
        // SAFETY: all pointers are to what lives until the call returns, or null where the header allows it; texts end with 0.
        let stream = unsafe {
            new(
                null(),
                c"Starball".as_ptr(),
                PLAYBACK,
                null(),
                c"game".as_ptr(),
                &raw const spec,
                null(),
                &raw const attributes,
                &raw mut error,
            )
        };
        if stream.is_null() {
            return Err(failure(text, error));
        }
        Ok(Self { stream, write, free, text })
    }

    /// Waits until there is room, and gives the samples to the server.
    pub(super) fn write(&mut self, samples: &[i16]) -> Result<(), OutputError> {
        let mut error = 0;
        // SAFETY: the stream is open until `drop`, and pointer and length are those of one slice.
        let status =
            unsafe { (self.write)(self.stream, samples.as_ptr().cast(), size_of_val(samples), &raw mut error) };
        if status < 0 { Err(failure(self.text, error)) } else { Ok(()) }
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        // SAFETY: the stream is open, and nobody uses it after this.
        unsafe { (self.free)(self.stream) };
    }
}

type AlsaOpen = unsafe extern "C" fn(*mut *mut c_void, *const c_char, c_int, c_int) -> c_int;
type AlsaSet = unsafe extern "C" fn(
    pcm: *mut c_void,
    format: c_int,
    access: c_int,
    channels: c_uint,
    rate: c_uint,
    resample: c_int,
    latency_us: c_uint,
) -> c_int;
type AlsaWrite = unsafe extern "C" fn(*mut c_void, *const c_void, c_ulong) -> c_long;
type AlsaRecover = unsafe extern "C" fn(*mut c_void, c_int, c_int) -> c_int;
type AlsaClose = unsafe extern "C" fn(*mut c_void) -> c_int;
/// It takes more after these, as `printf` does: nobody looks at it.
type AlsaHandler = unsafe extern "C" fn(*const c_char, c_int, *const c_char, c_int, *const c_char);
type AlsaSetHandler = unsafe extern "C" fn(Option<AlsaHandler>) -> c_int;

/// ALSA's default device.
pub(super) struct Alsa {
    device: *mut c_void,
    write: AlsaWrite,
    recover: AlsaRecover,
    close: AlsaClose,
    text: ErrorText,
}

impl Alsa {
    /// Finds the library and opens the default device.
    pub(super) fn open(rate: u32) -> Result<Self, OutputError> {
        const PLAYBACK: c_int = 0;
        const S16_LE: c_int = 2;
        const S16_BE: c_int = 3;
        const INTERLEAVED: c_int = 3;
        let library = load("libasound.so.2")?;
        // SAFETY: these are the functions' types as alsa/pcm.h and alsa/error.h of version 2 of the library declare them.
        let (open, set, write, recover, close, text, set_handler) = unsafe {
            (
                *library.get::<AlsaOpen>(c"snd_pcm_open")?,
                *library.get::<AlsaSet>(c"snd_pcm_set_params")?,
                *library.get::<AlsaWrite>(c"snd_pcm_writei")?,
                *library.get::<AlsaRecover>(c"snd_pcm_recover")?,
                *library.get::<AlsaClose>(c"snd_pcm_close")?,
                *library.get::<ErrorText>(c"snd_strerror")?,
                *library.get::<AlsaSetHandler>(c"snd_lib_error_set_handler")?,
            )
        };
        let mut device = null_mut();
        // SAFETY: the handler does nothing, whatever it is called with: on Linux it is the caller that takes arguments off
        // the stack. The pointers are to what lives until the call returns.
        let status = unsafe {
            set_handler(Some(say_nothing));
            open(&raw mut device, c"default".as_ptr(), PLAYBACK, 0)
        };
        if status < 0 {
            return Err(failure(text, status));
        }
        let device = Self { device, write, recover, close, text };
        let format = if LITTLE_ENDIAN { S16_LE } else { S16_BE };
        // SAFETY: the device is open.
        let status = unsafe { set(device.device, format, INTERLEAVED, CHANNELS.into(), rate, 1, 2 * STORE_MS * 1000) };
        if status < 0 { Err(failure(text, status)) } else { Ok(device) }
    }

    /// Waits until there is room, and gives the samples to the device.
    pub(super) fn write(&mut self, mut samples: &[i16]) -> Result<(), OutputError> {
        while !samples.is_empty() {
            let frames = samples.len() / usize::from(CHANNELS);
            // SAFETY: the device is open until `drop`, and the slice holds that many frames.
            let written = unsafe { (self.write)(self.device, samples.as_ptr().cast(), frames as c_ulong) };
            if written < 0 {
                // A gap in what it was given, for one, is no reason to end.
                // SAFETY: as above.
                let status = unsafe { (self.recover)(self.device, written as c_int, 1) };
                if status < 0 {
                    return Err(failure(self.text, status));
                }
                return Ok(());
            }
            samples = samples.get(written as usize * usize::from(CHANNELS)..).unwrap_or_default();
        }
        Ok(())
    }
}

impl Drop for Alsa {
    fn drop(&mut self) {
        // SAFETY: the device is open, and nobody uses it after this.
        unsafe { (self.close)(self.device) };
    }
}

/// ALSA writes to the terminal what it has tried; one line of ours says enough.
unsafe extern "C" fn say_nothing(_: *const c_char, _: c_int, _: *const c_char, _: c_int, _: *const c_char) {}

/// A library that stays for as long as the program runs: it may have started threads.
fn load(name: &str) -> Result<&'static Library, libloading::Error> {
    // SAFETY: what the library does when it is loaded is what it does in every program that links it.
    unsafe { Library::new(name) }.map(|library| &*Box::leak(Box::new(library)))
}

/// What the library calls an error.
fn failure(text: ErrorText, error: c_int) -> OutputError {
    // SAFETY: for any number the function returns a text that ends with 0 and stays, or null.
    let words = unsafe {
        let words = text(error);
        (!words.is_null()).then(|| CStr::from_ptr(words).to_string_lossy().into_owned())
    };
    OutputError::Device(words.unwrap_or_else(|| format!("error {error}")))
}
