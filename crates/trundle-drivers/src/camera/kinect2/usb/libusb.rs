//! The calls of libusb: the only unsafe code of the Kinect V2.
//!
//! Callbacks run inside [`Transfers::handle_events`], in the calling thread: no other code handles events of a context while transfers run.
//! Blocking transfers are only made before and after.

use super::functions::{DeviceDescriptor, LIBRARY, UsbApi, UsbContext, UsbHandle, UsbTransfer};
use super::ids::{self, KINECT2_NAME};
use crate::camera::native::library::LibraryVersion;
use crate::camera::{CameraError, UsbSpeed};
use std::ffi::{CStr, c_int, c_uint, c_void};
use std::ptr::NonNull;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Errors. Source: `libusb.h`.
const ERROR_ACCESS: c_int = -3;
const ERROR_NO_DEVICE: c_int = -4;
const ERROR_NOT_FOUND: c_int = -5;
const ERROR_BUSY: c_int = -6;
const ERROR_PIPE: c_int = -9;
const ERROR_NO_MEM: c_int = -11;
/// Kinds and states of transfers. Source: `libusb.h`.
const KIND_ISOCHRONOUS: u8 = 1;
const KIND_BULK: u8 = 2;
const STATUS_COMPLETED: c_int = 0;
const STATUS_CANCELLED: c_int = 3;
const STATUS_STALL: c_int = 4;
const STATUS_NO_DEVICE: c_int = 5;
/// Speeds. Source: `libusb.h`.
const SPEED_HIGH: c_int = 3;
const SPEED_SUPER: c_int = 4;
/// Longest wait for a blocking transfer \[ms\]: 1000. Source: \[Freenect2\].
const BLOCKING_TIMEOUT_MS: c_uint = 1000;
/// Longest wait for cancelled transfers \[ms\]. Source: ours; a host controller needs some milliseconds.
const CANCEL_TIMEOUT_MS: u64 = 2000;
/// Longest text of a descriptor \[bytes\]. Source: USB 3.1 specification, 9.6.9: 255 bytes, two per character.
const TEXT_BYTES: usize = 128;
/// Largest configuration descriptor that is read \[bytes\]. Source: ours; the device's has some 200 bytes.
const CONFIGURATION_BYTES: usize = 4096;

impl UsbApi {
    /// Version of the library.
    pub fn version(&self) -> LibraryVersion {
        // SAFETY: the function has no arguments; it returns a constant of the library, which is never unloaded.
        let version = unsafe { &*(self.libusb_get_version)() };
        LibraryVersion::new(version.major.into(), version.minor.into(), version.micro.into())
    }

    fn error_name(&self, code: c_int) -> String {
        // SAFETY: the function takes any number; it returns a constant that ends with a zero.
        unsafe { CStr::from_ptr((self.libusb_error_name)(code)) }.to_string_lossy().into_owned()
    }

    /// The number that `function` returned, or its error.
    fn check(&self, function: &'static str, code: c_int) -> Result<usize, CameraError> {
        let device = || KINECT2_NAME.to_owned();
        usize::try_from(code).map_err(|_| match code {
            ERROR_ACCESS => CameraError::NoPermission {
                device: device(),
                remedy: "install the udev rule of 'trundle devices --udev', run 'sudo adduser $USER plugdev', log in again, and plug the \
                    camera in again"
                    .into(),
            },
            ERROR_NO_DEVICE | ERROR_NOT_FOUND => CameraError::Unplugged { device: device() },
            ERROR_BUSY => CameraError::Busy { device: device() },
            ERROR_NO_MEM => self.failed(
                function,
                code,
                "raise the memory of USB: 'echo 64 | sudo tee /sys/module/usbcore/parameters/usbfs_memory_mb'",
            ),
            _ => self.failed(function, code, "unplug the camera from USB and power, and plug it in again"),
        })
    }

    fn failed(&self, function: &str, code: c_int, remedy: &str) -> CameraError {
        CameraError::LibraryFailed {
            library: LIBRARY.name.into(),
            function: function.into(),
            message: self.error_name(code),
            remedy: remedy.into(),
        }
    }
}

/// A session with libusb.
#[derive(Debug)]
pub(super) struct UsbSession {
    api: Arc<UsbApi>,
    context: NonNull<UsbContext>,
}

// SAFETY: libusb may be called from any thread.
unsafe impl Send for UsbSession {}

// SAFETY: as above.
unsafe impl Sync for UsbSession {}

/// A Kinect V2 in the list of devices.
#[derive(Debug)]
pub(super) struct Found {
    /// Speed of its connection; `None` if unknown.
    pub(super) speed: Option<UsbSpeed>,
    /// The open device, or why it cannot be opened.
    pub(super) opened: Result<UsbConnection, CameraError>,
    serial_text: u8,
}

impl UsbSession {
    /// Begins a session.
    pub(super) fn new(api: &Arc<UsbApi>) -> Result<Arc<Self>, CameraError> {
        let mut context = std::ptr::null_mut();
        // SAFETY: the context is writable.
        let code = unsafe { (api.libusb_init)(&mut context) };
        api.check("libusb_init", code)?;
        let context = NonNull::new(context).ok_or_else(|| api.failed("libusb_init", code, LIBRARY.remedy))?;
        Ok(Arc::new(Self { api: Arc::clone(api), context }))
    }

    /// All connected devices that are a Kinect V2, opened.
    pub(super) fn kinects(self: &Arc<Self>) -> Result<Vec<Found>, CameraError> {
        let mut list = std::ptr::null_mut();
        // SAFETY: the context is valid, and the list is writable.
        let count = unsafe { (self.api.libusb_get_device_list)(self.context.as_ptr(), &mut list) };
        let count = self.api.check("libusb_get_device_list", count as c_int)?;
        let mut found = Vec::new();
        for index in 0..count {
            // SAFETY: the list has `count` valid devices; they are valid until the list is freed. An open handle keeps its device valid.
            found.extend(unsafe { self.kinect(*list.add(index)) });
        }
        // SAFETY: the list came from the library and is not used afterwards; 1 releases its references to the devices.
        unsafe { (self.api.libusb_free_device_list)(list, 1) };
        Ok(found)
    }

    /// # Safety
    /// `device` is alive.
    unsafe fn kinect(self: &Arc<Self>, device: *mut super::functions::UsbDevice) -> Option<Found> {
        let mut descriptor = DeviceDescriptor::default();
        // SAFETY: the device is valid, and the descriptor is writable.
        let code = unsafe { (self.api.libusb_get_device_descriptor)(device, &mut descriptor) };
        if code < 0 || !ids::is_kinect2(descriptor.vendor, descriptor.product) {
            return None;
        }
        let mut handle = std::ptr::null_mut();
        // SAFETY: the device is valid, and the handle is writable.
        let (speed, code) = unsafe {
            ((self.api.libusb_get_device_speed)(device), (self.api.libusb_open)(device, &mut handle))
        };
        let opened = self.api.check("libusb_open", code).and_then(|_| {
            let handle =
                NonNull::new(handle).ok_or_else(|| self.api.failed("libusb_open", code, LIBRARY.remedy))?;
            Ok(UsbConnection { session: Arc::clone(self), handle })
        });
        Some(Found { speed: speed_of(speed), opened, serial_text: descriptor.serial_text })
    }
}

impl Drop for UsbSession {
    fn drop(&mut self) {
        // SAFETY: the context is valid; handles contain the session, so all of them are closed.
        unsafe { (self.api.libusb_exit)(self.context.as_ptr()) };
    }
}

impl Found {
    /// The serial number; empty if it cannot be read.
    pub(super) fn serial(&self) -> String {
        self.opened.as_ref().map(|handle| handle.text(self.serial_text)).unwrap_or_default()
    }
}

fn speed_of(speed: c_int) -> Option<UsbSpeed> {
    match speed {
        1..SPEED_HIGH => Some(UsbSpeed::Full),
        SPEED_HIGH => Some(UsbSpeed::High),
        SPEED_SUPER.. => Some(UsbSpeed::Super),
        _ => None,
    }
}

/// An open device.
#[derive(Debug)]
pub(super) struct UsbConnection {
    session: Arc<UsbSession>,
    handle: NonNull<UsbHandle>,
}

// SAFETY: libusb may be called from any thread.
unsafe impl Send for UsbConnection {}

impl UsbConnection {
    fn check(&self, function: &'static str, code: c_int) -> Result<usize, CameraError> {
        self.session.api.check(function, code)
    }

    fn text(&self, index: u8) -> String {
        let mut text = [0; TEXT_BYTES];
        let read = self.session.api.libusb_get_string_descriptor_ascii;
        // SAFETY: the device is open, and the text has its length.
        let length = unsafe { read(self.handle.as_ptr(), index, text.as_mut_ptr(), text.len() as c_int) };
        let text = text.get(..usize::try_from(length).unwrap_or(0)).unwrap_or_default();
        String::from_utf8_lossy(text).into_owned()
    }

    /// Selects `configuration`.
    pub(super) fn set_configuration(&self, configuration: u8) -> Result<(), CameraError> {
        let (api, handle) = (&self.session.api, self.handle.as_ptr());
        let mut current = 0;
        // SAFETY: the device is open, and the number is writable.
        self.check("libusb_get_configuration", unsafe {
            (api.libusb_get_configuration)(handle, &mut current)
        })?;
        if current != c_int::from(configuration) {
            // SAFETY: the device is open.
            let code = unsafe { (api.libusb_set_configuration)(handle, configuration.into()) };
            self.check("libusb_set_configuration", code)?;
        }
        Ok(())
    }

    /// Claims an interface exclusively.
    pub(super) fn claim(&self, interface: u8) -> Result<(), CameraError> {
        // SAFETY: the device is open.
        let code =
            unsafe { (self.session.api.libusb_claim_interface)(self.handle.as_ptr(), interface.into()) };
        self.check("libusb_claim_interface", code).map(drop)
    }

    /// Releases an interface. An unplugged device has none.
    pub(super) fn release(&self, interface: u8) {
        // SAFETY: the device is open; an interface that is not claimed is refused.
        unsafe { (self.session.api.libusb_release_interface)(self.handle.as_ptr(), interface.into()) };
    }

    /// Chooses the alternate `setting` of an interface that is claimed.
    pub(super) fn set_alternate(&self, interface: u8, setting: u8) -> Result<(), CameraError> {
        let set = self.session.api.libusb_set_interface_alt_setting;
        // SAFETY: the device is open.
        let code = unsafe { set(self.handle.as_ptr(), interface.into(), setting.into()) };
        self.check("libusb_set_interface_alt_setting", code).map(drop)
    }

    /// A control request without data.
    pub(super) fn control(&self, kind: u8, request: u8, value: u16, index: u16) -> Result<(), CameraError> {
        self.control_transfer((kind, request, value, index), &mut []).map(drop)
    }

    /// The active configuration descriptor. Source: USB 3.1 specification, 9.4.3: GET_DESCRIPTOR of a configuration.
    pub(super) fn configuration_descriptor(&self) -> Result<Vec<u8>, CameraError> {
        let mut bytes = vec![0; CONFIGURATION_BYTES];
        let length = self.control_transfer((0x80, 6, 0x0200, 0), &mut bytes)?;
        bytes.truncate(length);
        Ok(bytes)
    }

    fn control_transfer(
        &self,
        (kind, request, value, index): (u8, u8, u16, u16),
        data: &mut [u8],
    ) -> Result<usize, CameraError> {
        let transfer = self.session.api.libusb_control_transfer;
        let (handle, length) = (self.handle.as_ptr(), u16::try_from(data.len()).unwrap_or(u16::MAX));
        // SAFETY: the device is open, and the data have at least this length.
        let code = unsafe {
            transfer(handle, kind, request, value, index, data.as_mut_ptr(), length, BLOCKING_TIMEOUT_MS)
        };
        self.check("libusb_control_transfer", code)
    }

    /// Moves `data` through a bulk endpoint, in the direction of its address, and waits at most 1 s; the number of bytes moved.
    pub(super) fn bulk(&self, endpoint: u8, data: &mut [u8]) -> Result<usize, CameraError> {
        let transfer = self.session.api.libusb_bulk_transfer;
        let (mut moved, length) = (0, c_int::try_from(data.len()).unwrap_or(c_int::MAX));
        // SAFETY: the device is open, and the data have at least this length.
        let code = unsafe {
            transfer(
                self.handle.as_ptr(),
                endpoint,
                data.as_mut_ptr(),
                length,
                &mut moved,
                BLOCKING_TIMEOUT_MS,
            )
        };
        self.check("libusb_bulk_transfer", code)?;
        Ok(usize::try_from(moved).unwrap_or(0).min(data.len()))
    }
}

impl Drop for UsbConnection {
    fn drop(&mut self) {
        // SAFETY: the device is open, and transfers borrow it.
        unsafe { (self.session.api.libusb_close)(self.handle.as_ptr()) };
    }
}

/// Arrival at an endpoint: the bytes, or `None` if they were lost.
pub(super) type Arrival<'a> = (u8, Option<&'a [u8]>);

/// Sizes of the transfers of one endpoint.
#[derive(Debug, Clone, Copy)]
pub(super) struct TransferPlan {
    /// Address of the endpoint.
    pub(super) endpoint: u8,
    /// Transfers that wait at the same time.
    pub(super) count: usize,
    /// Isochronous packets of one transfer; 0 for a bulk transfer.
    pub(super) packets: usize,
    /// Bytes of a packet, or of a bulk transfer.
    pub(super) bytes: usize,
}

/// State that the callbacks share.
struct Shared<'a> {
    api: Arc<UsbApi>,
    on_arrival: Box<dyn FnMut(Arrival<'_>) + 'a>,
    waiting: usize,
    is_stopping: bool,
    /// First error of a transfer that was submitted again.
    fault: Option<c_int>,
}

/// Transfers that are resubmitted after their arrival.
pub(super) struct Transfers<'a> {
    handle: &'a UsbConnection,
    shared: NonNull<Shared<'a>>,
    transfers: Vec<(NonNull<UsbTransfer>, Vec<u8>)>,
}

impl<'a> Transfers<'a> {
    /// Submits all transfers; `on_arrival` gets what arrives, in the order of arrival.
    pub(super) fn start(
        handle: &'a UsbConnection,
        plans: &[TransferPlan],
        on_arrival: impl FnMut(Arrival<'_>) + 'a,
    ) -> Result<Self, CameraError> {
        let api = Arc::clone(&handle.session.api);
        let shared =
            Shared { api, on_arrival: Box::new(on_arrival), waiting: 0, is_stopping: false, fault: None };
        let shared = NonNull::from(Box::leak(Box::new(shared)));
        let mut transfers = Self { handle, shared, transfers: Vec::new() };
        for plan in plans {
            for _ in 0..plan.count {
                transfers.submit(plan)?;
            }
        }
        Ok(transfers)
    }

    fn submit(&mut self, plan: &TransferPlan) -> Result<(), CameraError> {
        let api = &self.handle.session.api;
        let mut buffer = vec![0; plan.packets.max(1) * plan.bytes];
        // SAFETY: the function takes any number of packets.
        let transfer = unsafe { (api.libusb_alloc_transfer)(plan.packets as c_int) };
        let transfer = NonNull::new(transfer)
            .ok_or_else(|| api.failed("libusb_alloc_transfer", ERROR_NO_MEM, "free some memory"))?;
        // SAFETY: the transfer is valid and has space for its packets; the buffer does not move until the transfer is freed.
        let code = unsafe {
            fill(
                transfer.as_ptr(),
                self.handle.handle.as_ptr(),
                plan,
                &mut buffer,
                self.shared.as_ptr().cast(),
            );
            (api.libusb_submit_transfer)(transfer.as_ptr())
        };
        self.transfers.push((transfer, buffer));
        api.check("libusb_submit_transfer", code)?;
        // SAFETY: no callback runs, because no code handles events.
        unsafe { (*self.shared.as_ptr()).waiting += 1 };
        Ok(())
    }

    /// Runs the callbacks for at most `timeout`.
    ///
    /// # Errors
    /// When the device is unplugged or a transfer failed.
    pub(super) fn handle_events(&mut self, timeout: Duration) -> Result<(), CameraError> {
        let code = self.run_events(timeout);
        let api = &self.handle.session.api;
        api.check("libusb_handle_events_timeout_completed", code)?;
        // SAFETY: no callback runs: callbacks run only inside the function above.
        let fault = unsafe { (*self.shared.as_ptr()).fault };
        fault.map_or(Ok(()), |code| api.check("libusb_submit_transfer", code).map(drop))
    }

    fn run_events(&self, timeout: Duration) -> c_int {
        let session = &self.handle.session;
        let mut time = libc::timeval {
            tv_sec: timeout.as_secs().min(60) as libc::time_t,
            tv_usec: libc::suseconds_t::from(timeout.subsec_micros()),
        };
        let handle_events = session.api.libusb_handle_events_timeout_completed;
        // SAFETY: context and time are valid; a null place for completion is allowed.
        unsafe { handle_events(session.context.as_ptr(), &mut time, std::ptr::null_mut()) }
    }

    fn waiting(&self) -> usize {
        // SAFETY: no callback runs outside of `run_events`.
        unsafe { (*self.shared.as_ptr()).waiting }
    }

    /// Cancels all transfers and waits for their end. Returns whether all ended.
    fn cancel(&mut self) -> bool {
        // SAFETY: no callback runs outside of `run_events`.
        unsafe { (*self.shared.as_ptr()).is_stopping = true };
        for (transfer, _) in &self.transfers {
            // SAFETY: the transfer is valid; cancelling an inactive transfer is refused.
            unsafe { (self.handle.session.api.libusb_cancel_transfer)(transfer.as_ptr()) };
        }
        let start = Instant::now();
        while self.waiting() > 0 && start.elapsed() < Duration::from_millis(CANCEL_TIMEOUT_MS) {
            self.run_events(Duration::from_millis(10));
        }
        self.waiting() == 0
    }
}

impl Drop for Transfers<'_> {
    fn drop(&mut self) {
        if !self.cancel() {
            // The memory is leaked, because the library may still write to it. The callback's borrow ends here, so the callback is
            // replaced.
            tracing::warn!("{} USB transfers did not end: their memory is lost", self.waiting());
            // SAFETY: no callback runs outside of `run_events`.
            unsafe { (*self.shared.as_ptr()).on_arrival = Box::new(|_| {}) };
            return std::mem::take(&mut self.transfers)
                .into_iter()
                .for_each(|(_, buffer)| std::mem::forget(buffer));
        }
        for (transfer, _) in &self.transfers {
            // SAFETY: the transfer ended and is not used afterwards.
            unsafe { (self.handle.session.api.libusb_free_transfer)(transfer.as_ptr()) };
        }
        // SAFETY: the pointer came from a box, and no transfer refers to it.
        drop(unsafe { Box::from_raw(self.shared.as_ptr()) });
    }
}

/// Fills a transfer.
///
/// # Safety
/// `transfer` must be valid with space for its packets; `buffer` and `shared` must outlive it.
unsafe fn fill(
    transfer: *mut UsbTransfer,
    handle: *mut UsbHandle,
    plan: &TransferPlan,
    buffer: &mut [u8],
    shared: *mut c_void,
) {
    // SAFETY: the caller vouches for the transfer and its packets.
    unsafe {
        (*transfer).handle = handle;
        (*transfer).endpoint = plan.endpoint;
        (*transfer).kind = if plan.packets > 0 { KIND_ISOCHRONOUS } else { KIND_BULK };
        (*transfer).timeout_ms = 0;
        (*transfer).length = buffer.len() as c_int;
        (*transfer).callback = Some(on_transfer);
        (*transfer).user_data = shared;
        (*transfer).buffer = buffer.as_mut_ptr();
        (*transfer).packet_count = plan.packets as c_int;
        let packets = (&raw mut (*transfer).packets).cast::<super::functions::IsoPacket>();
        for index in 0..plan.packets {
            (*packets.add(index)).length = plan.bytes as c_uint;
        }
    }
}

/// Passes on what arrived, and submits the transfer again.
///
/// # Safety
/// `transfer` must have been filled by [`fill`], and its buffer and shared part must be valid.
unsafe extern "C" fn on_transfer(transfer: *mut UsbTransfer) {
    // SAFETY: the caller guarantees a valid transfer. Callbacks run one after the other, inside `run_events`, while no other code uses
    // `Shared`.
    let shared = unsafe { &mut *(*transfer).user_data.cast::<Shared<'_>>() };
    // SAFETY: as above.
    let status = unsafe { (*transfer).status };
    if !shared.is_stopping && status != STATUS_CANCELLED {
        // SAFETY: as above.
        unsafe { pass_on(transfer, &mut shared.on_arrival) };
    }
    let code = match status {
        STATUS_STALL => ERROR_PIPE,
        STATUS_CANCELLED | STATUS_NO_DEVICE => ERROR_NO_DEVICE,
        _ if shared.is_stopping => ERROR_NO_DEVICE,
        // SAFETY: as above.
        _ => unsafe { (shared.api.libusb_submit_transfer)(transfer) },
    };
    if code < 0 {
        shared.waiting = shared.waiting.saturating_sub(1);
        if !shared.is_stopping {
            shared.fault.get_or_insert(code);
        }
    }
}

/// Passes on the bytes of a transfer, packet by packet.
///
/// # Safety
/// As for [`on_transfer`].
unsafe fn pass_on(transfer: *mut UsbTransfer, on_arrival: &mut dyn FnMut(Arrival<'_>)) {
    // SAFETY: the caller vouches for the transfer; the buffer holds `length` bytes.
    let (endpoint, status, actual, count, buffer) = unsafe {
        let buffer = std::slice::from_raw_parts((*transfer).buffer, (*transfer).length.max(0) as usize);
        (
            (*transfer).endpoint,
            (*transfer).status,
            (*transfer).actual_length,
            (*transfer).packet_count,
            buffer,
        )
    };
    if count <= 0 {
        let bytes = buffer.get(..usize::try_from(actual).unwrap_or(0));
        return on_arrival((endpoint, bytes.filter(|_| status == STATUS_COMPLETED)));
    }
    // SAFETY: the transfer has `count` packets after its end.
    let packets = unsafe {
        let first = (&raw const (*transfer).packets).cast::<super::functions::IsoPacket>();
        std::slice::from_raw_parts(first, count as usize)
    };
    let mut start = 0;
    for packet in packets {
        let bytes = buffer.get(start..).and_then(|rest| rest.get(..packet.actual_length as usize));
        on_arrival((endpoint, bytes.filter(|_| packet.status == STATUS_COMPLETED)));
        start += packet.length as usize;
    }
}
