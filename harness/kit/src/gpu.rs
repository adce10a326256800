//! Lists and selects adapters, and waits for devices with a time-out.

use riprap::{Error, Result, wgpu};
use std::{
    future::Future,
    pin::pin,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    task::{Context, Poll, Wake, Waker},
    time::{Duration, Instant},
};

/// Advice if there is no adapter.
pub const HINT: &str = "no GPU adapter was found; install a Vulkan driver for your GPU, or the \
    software one: apt-get install mesa-vulkan-drivers libvulkan1";

/// All adapters with compute shaders, GPUs first, then Vulkan on the CPU, then OpenGL.
pub fn adapters() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let mut found: Vec<_> = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
        .into_iter()
        .filter(|a| a.limits().max_compute_invocations_per_workgroup >= 64)
        .collect();
    found.sort_by_key(|a| rank(&a.get_info()));
    found
}

fn rank(info: &wgpu::AdapterInfo) -> u32 {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        _ if is_software(info) => 4,
        _ => 3,
    };
    let backend = match info.backend {
        wgpu::Backend::Gl => 1,
        _ => 0,
    };
    2 * kind + backend
}

/// Whether the adapter computes on the CPU.
pub fn is_software(info: &wgpu::AdapterInfo) -> bool {
    let name = info.name.to_lowercase();
    info.device_type == wgpu::DeviceType::Cpu
        || ["llvmpipe", "lavapipe", "swiftshader", "softpipe"]
            .iter()
            .any(|s| name.contains(s))
}

/// Name, back end and driver in one line.
pub fn describe(info: &wgpu::AdapterInfo) -> String {
    let driver = format!("{} {}", info.driver, info.driver_info);
    format!("{} ({:?}, {})", info.name, info.backend, driver.trim())
}

/// The adapter whose description contains `name`, or the first one.
pub fn pick(name: Option<&str>) -> Result<wgpu::Adapter> {
    let all = adapters();
    if all.is_empty() {
        return Err(Error::Device(HINT.into()));
    }
    let names: Vec<_> = all.iter().map(|a| describe(&a.get_info())).collect();
    let wanted = name.unwrap_or_default().to_lowercase();
    let at = names
        .iter()
        .position(|n| n.to_lowercase().contains(&wanted));
    at.and_then(|at| all.into_iter().nth(at)).ok_or_else(|| {
        Error::Device(format!(
            "no adapter is called '{}'; there are: {}",
            name.unwrap_or_default(),
            names.join("; ")
        ))
    })
}

/// The adapters whose description contains the environment variable `RIPRAP_ADAPTER`, or all; used by benches.
pub fn wanted() -> impl Iterator<Item = wgpu::Adapter> {
    let wanted = std::env::var("RIPRAP_ADAPTER").unwrap_or_default();
    let wanted = wanted.to_lowercase();
    let describe = |adapter: &wgpu::Adapter| describe(&adapter.get_info()).to_lowercase();
    adapters()
        .into_iter()
        .filter(move |adapter| describe(adapter).contains(&wanted))
}

/// The adapter whose description contains the environment variable `RIPRAP_ADAPTER`, or the first one; used by tests.
pub fn selected() -> Result<wgpu::Adapter> {
    pick(std::env::var("RIPRAP_ADAPTER").ok().as_deref())
}

/// A device with the given features and limits.
pub fn open(
    adapter: &wgpu::Adapter,
    features: wgpu::Features,
    limits: wgpu::Limits,
) -> Result<(wgpu::Device, wgpu::Queue)> {
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("riprap"),
        required_features: features,
        required_limits: limits,
        ..Default::default()
    });
    pollster::block_on(request).map_err(|e| Error::Device(e.to_string()))
}

/// Time between two polls of a GPU: short compared with a step.
const NAP: Duration = Duration::from_micros(20);
/// Time for which the host polls a silent GPU continuously, which occupies a core.
const AWAKE: Duration = Duration::from_millis(2);

/// Runs `future` to its end, polling the device for it.
///
/// A GPU is polled often, so that the host can process finished work while the GPU continues; a CPU adapter shares the cores
/// of the host, which waits until all is done. A device silent for `patience` is an error: drivers may hang on infinite waits.
pub fn drive<T>(
    device: &wgpu::Device,
    patience: Duration,
    what: &str,
    future: impl Future<Output = T>,
) -> Result<T> {
    let looks = !is_software(&device.adapter_info());
    drive_by(device, looks, patience, what, future)
}

/// The same, either by polling the device or by waiting for all submitted work.
pub fn drive_by<T>(
    device: &wgpu::Device,
    looks: bool,
    patience: Duration,
    what: &str,
    future: impl Future<Output = T>,
) -> Result<T> {
    /// Whether the device has woken the future.
    #[derive(Default)]
    struct Came(AtomicBool);
    impl Wake for Came {
        fn wake(self: Arc<Self>) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
    let came = Arc::new(Came::default());
    let waker = Waker::from(Arc::clone(&came));
    let mut future = pin!(future);
    let mut heard = Instant::now();
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut Context::from_waker(&waker)) {
            return Ok(value);
        }
        if came.0.swap(false, Ordering::Relaxed) {
            heard = Instant::now();
        }
        let left = patience.saturating_sub(heard.elapsed());
        let waited = device.poll(match looks {
            true => wgpu::PollType::Poll,
            false => wgpu::PollType::Wait {
                submission_index: None,
                timeout: Some(left.min(Duration::from_secs(1))),
            },
        });
        match waited {
            Err(wgpu::PollError::Timeout) | Ok(_) => {}
            Err(error) => return Err(Error::DeviceLost(error.to_string())),
        }
        match looks {
            // A sleep lasts longer than requested, which would delay the steps of a small scene.
            true if heard.elapsed() < AWAKE => std::thread::yield_now(),
            true => std::thread::sleep(NAP),
            false => {}
        }
        if heard.elapsed() >= patience {
            return Err(Error::Timeout {
                what: what.into(),
                seconds: patience.as_secs_f64(),
                remedy: "use fewer steps at a time, a smaller grid, or another adapter".into(),
            });
        }
    }
}
