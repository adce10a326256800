//! Buffers on a device.

/// A buffer with this content, padded with zeros to whole words.
///
/// On a device that is lost or full the buffer is not valid, as those of `wgpu::Device::create_buffer` are: who uses it
/// learns of that from an error scope. (`DeviceExt::create_buffer_init` of wgpu panics there.)
pub(crate) fn filled(
    device: &wgpu::Device,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let word = wgpu::COPY_BUFFER_ALIGNMENT;
    let size = (contents.len() as u64).next_multiple_of(word);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: size > 0,
    });
    if size > 0
        && let Ok(mut view) = buffer.get_mapped_range_mut(..)
    {
        view.slice(..contents.len()).copy_from_slice(contents);
        drop(view);
        buffer.unmap();
    }
    buffer
}

/// A storage buffer of `bytes`, all zero, that can be written, read back and cleared.
pub(crate) fn zeroed(device: &wgpu::Device, label: &str, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

/// A uniform buffer of `bytes`.
pub(crate) fn uniform(device: &wgpu::Device, label: &str, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
