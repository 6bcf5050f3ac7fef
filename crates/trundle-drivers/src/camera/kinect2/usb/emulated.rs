//! An emulated Kinect V2 behind the functions of libusb, for the parts that need a device: commands, transfers, threads.
//!
//! The emulation cannot verify the behaviour of a device. It verifies the order of the calls, that no data is lost, and that all memory is
//! freed.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use super::functions::*;
use super::{Kinect2UsbCamera, color_packets, ids, list_devices, reply};
use crate::camera::kinect2::layout::{IMAGE_BYTES, IMAGE_COUNT, PIXEL_COUNT};
use crate::camera::native::Selection;
use crate::camera::native::library::NativeLibrary;
use crate::camera::{CameraError, DepthCamera, PixelFormat};
use std::collections::VecDeque;
use std::ffi::{c_char, c_int, c_uint};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

/// The state of the emulated library. Pointers are numbers here: another thread may own them.
#[derive(Default)]
struct Emulated {
    speed: c_int,
    is_unplugged: bool,
    is_streaming: bool,
    depth_setting: c_int,
    commands: Vec<u32>,
    replies: VecDeque<Vec<u8>>,
    /// Transfers that wait: address, and whether they are cancelled.
    waiting: VecDeque<(usize, bool)>,
    color: VecDeque<Vec<u8>>,
    depth: VecDeque<Vec<u8>>,
    /// Contexts, handles, interfaces and transfers that are not given back.
    open: [i32; 4],
}

static STATE: Mutex<Option<Emulated>> = Mutex::new(None);
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn with<T>(act: impl FnOnce(&mut Emulated) -> T) -> T {
    let mut state: MutexGuard<'_, Option<Emulated>> = STATE.lock().unwrap();
    act(state.get_or_insert_default())
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

unsafe extern "C" fn version() -> *const UsbVersion {
    unreachable!("the emulated library is not asked for its version")
}
unsafe extern "C" fn init(context: *mut *mut UsbContext) -> c_int {
    with(|state| state.open[0] += 1);
    // SAFETY: the caller gives a place. The number is never followed.
    unsafe { *context = std::ptr::without_provenance_mut(8) };
    0
}
unsafe extern "C" fn exit(_: *mut UsbContext) {
    with(|state| state.open[0] -= 1);
}
unsafe extern "C" fn error_name(_: c_int) -> *const c_char {
    c"EMULATED".as_ptr()
}
unsafe extern "C" fn device_list(_: *mut UsbContext, list: *mut *mut *mut UsbDevice) -> isize {
    let devices: Box<[*mut UsbDevice; 2]> =
        Box::new([std::ptr::without_provenance_mut(8), std::ptr::without_provenance_mut(16)]);
    // SAFETY: the caller gives a place.
    unsafe { *list = Box::into_raw(devices).cast() };
    2
}
unsafe extern "C" fn free_list(list: *mut *mut UsbDevice, _: c_int) {
    // SAFETY: it came from `device_list`.
    drop(unsafe { Box::from_raw(list.cast::<[*mut UsbDevice; 2]>()) });
}
unsafe extern "C" fn descriptor(device: *mut UsbDevice, descriptor: *mut DeviceDescriptor) -> c_int {
    // SAFETY: the caller gives a place.
    let descriptor = unsafe { &mut *descriptor };
    (descriptor.vendor, descriptor.product) =
        if device.addr() == 16 { (ids::VENDOR_ID, ids::PRODUCT_IDS[1]) } else { (0x1d6b, 3) };
    descriptor.serial_text = 3;
    0
}
unsafe extern "C" fn speed(_: *mut UsbDevice) -> c_int {
    with(|state| state.speed)
}
unsafe extern "C" fn text(_: *mut UsbHandle, _: u8, text: *mut u8, _: c_int) -> c_int {
    // SAFETY: the caller gives 128 bytes.
    unsafe { std::slice::from_raw_parts_mut(text, 6) }.copy_from_slice(b"012345");
    6
}
unsafe extern "C" fn open(_: *mut UsbDevice, handle: *mut *mut UsbHandle) -> c_int {
    with(|state| state.open[1] += 1);
    // SAFETY: the caller gives a place. The number is never followed.
    unsafe { *handle = std::ptr::without_provenance_mut(24) };
    0
}
unsafe extern "C" fn close(_: *mut UsbHandle) {
    with(|state| state.open[1] -= 1);
}
unsafe extern "C" fn configuration(_: *mut UsbHandle, number: *mut c_int) -> c_int {
    // SAFETY: the caller gives a place.
    unsafe { *number = 1 };
    0
}
unsafe extern "C" fn set_configuration(_: *mut UsbHandle, _: c_int) -> c_int {
    0
}
unsafe extern "C" fn claim(_: *mut UsbHandle, _: c_int) -> c_int {
    with(|state| state.open[2] += 1);
    0
}
unsafe extern "C" fn release(_: *mut UsbHandle, _: c_int) -> c_int {
    with(|state| state.open[2] -= 1);
    0
}
unsafe extern "C" fn alternate(_: *mut UsbHandle, _: c_int, setting: c_int) -> c_int {
    with(|state| state.depth_setting = setting);
    0
}
unsafe extern "C" fn control(
    _: *mut UsbHandle,
    _: u8,
    request: u8,
    _: u16,
    _: u16,
    data: *mut u8,
    length: u16,
    _: c_uint,
) -> c_int {
    const ANSWER: [u8; 22] = [9, 4, 1, 1, 1, 255, 0, 0, 0, 7, 5, 0x84, 1, 0, 4, 1, 6, 48, 0, 0, 0, 0x84];
    if request != 6 || usize::from(length) < ANSWER.len() {
        return 0;
    }
    // SAFETY: the caller gives `length` bytes.
    unsafe { std::slice::from_raw_parts_mut(data, ANSWER.len()) }.copy_from_slice(&ANSWER);
    ANSWER.len() as c_int
}
unsafe extern "C" fn bulk(
    _: *mut UsbHandle,
    endpoint: u8,
    data: *mut u8,
    length: c_int,
    moved: *mut c_int,
    _: c_uint,
) -> c_int {
    // SAFETY: the caller gives `length` bytes and a place.
    let (data, moved) = unsafe { (std::slice::from_raw_parts_mut(data, length as usize), &mut *moved) };
    with(|state| {
        if state.is_unplugged {
            return -4;
        }
        if endpoint == ids::REQUEST_ENDPOINT {
            state.answer(data);
            *moved = length;
            return 0;
        }
        let Some(reply) = state.replies.pop_front() else { return -7 };
        data[..reply.len()].copy_from_slice(&reply);
        *moved = reply.len() as c_int;
        0
    })
}
unsafe extern "C" fn alloc(packets: c_int) -> *mut UsbTransfer {
    with(|state| state.open[3] += 1);
    // SAFETY: all fields may be zero.
    unsafe { libc::calloc(1, 64 + 12 * packets as usize) }.cast()
}
unsafe extern "C" fn free(transfer: *mut UsbTransfer) {
    with(|state| state.open[3] -= 1);
    // SAFETY: it came from `alloc`.
    unsafe { libc::free(transfer.cast()) };
}
unsafe extern "C" fn submit(transfer: *mut UsbTransfer) -> c_int {
    with(|state| state.waiting.push_back((transfer.expose_provenance(), false)));
    0
}
unsafe extern "C" fn cancel(transfer: *mut UsbTransfer) -> c_int {
    let mark = |entry: &mut (usize, bool)| entry.1 |= entry.0 == transfer.addr();
    with(|state| state.waiting.iter_mut().for_each(mark));
    0
}
/// Ends cancelled transfers, or the first transfer of each endpoint with bytes.
unsafe extern "C" fn handle_events(_: *mut UsbContext, _: *mut libc::timeval, _: *mut c_int) -> c_int {
    let waiting = with(|state| std::mem::take(&mut state.waiting));
    let mut ended = Vec::new();
    for (address, is_cancelled) in waiting {
        let transfer: *mut UsbTransfer = std::ptr::with_exposed_provenance_mut(address);
        // SAFETY: transfers live until they are freed, which happens after they ended.
        if unsafe { with(|state| state.fill(&mut *transfer, is_cancelled)) } {
            ended.push(transfer);
        } else {
            with(|state| state.waiting.push_back((address, is_cancelled)));
        }
    }
    for transfer in &ended {
        // SAFETY: as above; the callback was set before the transfer was submitted.
        unsafe { ((**transfer).callback.unwrap())(*transfer) };
    }
    if ended.is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    0
}

impl Emulated {
    /// Answers a request according to the protocol.
    fn answer(&mut self, request: &[u8]) {
        let fields: Vec<u32> =
            request.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        let (sequence, limit, code) = (fields[1], fields[2] as usize, fields[3]);
        self.commands.push(code);
        let mut data = match (code, fields.get(5)) {
            (0x02, _) => [vec![0; 48], words(&[0x0004_0003, 3912, 0, 0])].concat(),
            (0x14, _) => vec![0; 92],
            (0x16, _) => words(&[1]),
            (0x22, Some(1)) => b"0\x001\x002\x003\x004\x005\x00\0\0".to_vec(),
            (0x22, Some(2)) => vec![0; 32 + 3 * 2 * (PIXEL_COUNT + 2)],
            (0x22, Some(3)) => floats(&[365.0, 365.0, 0.0, 256.0, 212.0, 0.09, -0.27, 0.0, 0.0, 0.1]),
            (0x22, Some(_)) => {
                let mut polynomial = [0.0; 20];
                (polynomial[7], polynomial[9], polynomial[18]) = (0.65, 0.1433, 0.65);
                [vec![1], floats(&[1081.37, 959.5, 539.5, 863.0, 52.0]), floats(&polynomial)].concat()
            }
            (0x2b, Some(is_on)) => {
                self.is_streaming = *is_on == 1;
                Vec::new()
            }
            _ => Vec::new(),
        };
        data.truncate(limit);
        self.replies.extend((limit > 0).then_some(data));
        self.replies.push_back(words(&[reply::COMPLETION_MAGIC, sequence, 0, 0]));
    }

    /// Ends a transfer if bytes or a cancellation are pending.
    ///
    /// # Safety
    /// The transfer has its packets and its buffer.
    unsafe fn fill(&mut self, transfer: &mut UsbTransfer, is_cancelled: bool) -> bool {
        transfer.status = match (is_cancelled, self.is_unplugged) {
            (true, _) => 3,
            (_, true) => 5,
            _ => 0,
        };
        let queue = if transfer.endpoint == ids::DEPTH_ENDPOINT { &mut self.depth } else { &mut self.color };
        if transfer.status != 0 {
            return true;
        }
        if !self.is_streaming || queue.is_empty() {
            return false;
        }
        // SAFETY: the caller vouches for the buffer.
        let buffer = unsafe { std::slice::from_raw_parts_mut(transfer.buffer, transfer.length as usize) };
        if transfer.packet_count == 0 {
            let bytes = queue.pop_front().unwrap();
            buffer[..bytes.len()].copy_from_slice(&bytes);
            transfer.actual_length = bytes.len() as c_int;
            return true;
        }
        let packets = (&raw mut transfer.packets).cast::<IsoPacket>();
        let mut start = 0;
        for index in 0..transfer.packet_count as usize {
            // SAFETY: the caller vouches for the packets.
            let packet = unsafe { &mut *packets.add(index) };
            let bytes = queue.pop_front().unwrap_or_default();
            buffer[start..start + bytes.len()].copy_from_slice(&bytes);
            (packet.actual_length, packet.status) = (bytes.len() as c_uint, 0);
            start += packet.length as usize;
        }
        true
    }

    /// Queues a colour image whose left half is red, and a frame of depth.
    fn queue_frame(&mut self, sequence: u32) {
        let image = image::RgbImage::from_fn(1920, 1080, |x, _| {
            image::Rgb(if x < 960 { [255, 0, 0] } else { [0, 0, 255] })
        });
        let mut jpeg = std::io::Cursor::new(Vec::new());
        image.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
        let mut color = [words(&[sequence, color_packets::HEADER_MAGIC]), jpeg.into_inner()].concat();
        let length = (color.len() + color_packets::FOOTER_BYTES) as u32;
        let footer = [color_packets::FOOTER_MAGIC, sequence, 0, 0, 0, 267 * sequence, 0, 0];
        color.extend(words(&footer));
        color.extend(words(&[color_packets::HEADER_MAGIC, length, 0, 0, 0, 0]));
        self.color.extend(color.chunks(0x4000).map(<[u8]>::to_vec));
        for subsequence in 0..IMAGE_COUNT as u32 {
            let mut bytes = vec![0; IMAGE_BYTES];
            bytes.extend(words(&[0, 9, 267 * sequence, sequence, subsequence, IMAGE_BYTES as u32]));
            bytes.extend([0; 128]);
            self.depth.extend(bytes.chunks(0x8400).map(<[u8]>::to_vec));
            self.depth.push_back(Vec::new());
        }
    }
}

/// The functions of the emulated library. Any loaded library replaces its file.
fn api() -> Arc<UsbApi> {
    Arc::new(UsbApi {
        library: NativeLibrary::load(LIBRARY, Some(Path::new("libc.so.6"))).unwrap(),
        libusb_get_version: version,
        libusb_init: init,
        libusb_exit: exit,
        libusb_error_name: error_name,
        libusb_get_device_list: device_list,
        libusb_free_device_list: free_list,
        libusb_get_device_descriptor: descriptor,
        libusb_get_device_speed: speed,
        libusb_get_string_descriptor_ascii: text,
        libusb_open: open,
        libusb_close: close,
        libusb_get_configuration: configuration,
        libusb_set_configuration: set_configuration,
        libusb_claim_interface: claim,
        libusb_release_interface: release,
        libusb_set_interface_alt_setting: alternate,
        libusb_control_transfer: control,
        libusb_bulk_transfer: bulk,
        libusb_alloc_transfer: alloc,
        libusb_free_transfer: free,
        libusb_submit_transfer: submit,
        libusb_cancel_transfer: cancel,
        libusb_handle_events_timeout_completed: handle_events,
    })
}

fn plugged_in(speed: c_int) -> (MutexGuard<'static, ()>, Arc<UsbApi>) {
    let guard = ONE_AT_A_TIME.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    *STATE.lock().unwrap_or_else(std::sync::PoisonError::into_inner) =
        Some(Emulated { speed, ..Emulated::default() });
    (guard, api())
}

#[test]
fn frames_come_through_commands_transfers_and_the_thread() {
    let (_guard, api) = plugged_in(4);
    let mut camera = Kinect2UsbCamera::open(&api, &Selection::Serial("012345".into())).unwrap();
    let info = camera.info();
    assert_eq!((info.serial.as_str(), info.firmware.as_str()), ("012345", "4.3.3912.0"));
    assert!((info.depth.camera.cx() - 255.5).abs() < 1e-9 && (info.color.camera.fx() - 1081.37).abs() < 1e-3);
    assert_eq!(with(|state| state.depth_setting), 1);
    for sequence in 1..4 {
        with(|state| state.queue_frame(sequence));
        let frame = camera.next_frame(Duration::from_secs(20)).unwrap().unwrap();
        assert_eq!((frame.color.format, frame.depth.format), (PixelFormat::Rgb8, PixelFormat::DepthF32));
        assert_eq!((frame.color.bytes.len(), frame.depth.bytes.len()), (1920 * 1080 * 3, 4 * PIXEL_COUNT));
        assert_eq!(frame.color.device_stamp, frame.depth.device_stamp);
        assert!(
            frame.color.bytes[0] < 50 && frame.color.bytes[2] > 200,
            "the left half is the right one of the mirrored image"
        );
    }
    assert!(camera.next_frame(Duration::from_millis(20)).unwrap().is_none(), "no frame is queued");
    drop(camera);
    let (open, setting, last) =
        with(|state| (state.open, state.depth_setting, state.commands.last().copied()));
    assert_eq!(
        (open, setting, last),
        ([0; 4], 0, Some(0)),
        "all is given back, the last command is the shutdown"
    );
}

#[test]
fn a_device_that_is_unplugged_is_gone_and_all_memory_is_freed() {
    let (_guard, api) = plugged_in(4);
    let mut camera = Kinect2UsbCamera::open(&api, &Selection::First).unwrap();
    with(|state| state.is_unplugged = true);
    let error = camera.next_frame(Duration::from_secs(20)).unwrap_err();
    assert!(matches!(error, CameraError::Unplugged { .. }), "{error}");
    assert!(camera.next_frame(Duration::from_millis(1)).is_err(), "it stays gone");
    drop(camera);
    assert_eq!(with(|state| state.open), [0; 4]);
}

#[test]
fn a_slow_port_and_another_serial_number_are_refused() {
    let (_guard, api) = plugged_in(3);
    let error = Kinect2UsbCamera::open(&api, &Selection::First).unwrap_err();
    assert!(matches!(error, CameraError::UsbTooSlow { .. }), "{error}");
    let error = Kinect2UsbCamera::open(&api, &Selection::Serial("9".into())).unwrap_err();
    assert!(matches!(error, CameraError::NoDevice { .. }), "{error}");
    let devices = list_devices(&api).unwrap();
    assert_eq!((devices.len(), devices[0].serial.as_str()), (1, "012345"));
    assert_eq!(with(|state| state.open), [0; 4]);
}
