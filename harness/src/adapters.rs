//! `riprap adapters`: lists the devices to compute on.

use crate::{gpu, print};
use anyhow::Result;
use riprap::{Error, wgpu};
use serde::Serialize;
use std::fmt::Write;

/// Lists the adapters in the order in which they are tried: the first is the default.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// An adapter and its limits.
#[derive(Debug, Serialize)]
pub struct Adapter {
    /// Name of the device.
    pub name: String,
    /// Interface through which it is used.
    pub backend: String,
    /// Driver with its version.
    pub driver: String,
    /// Kind of device.
    pub kind: String,
    /// Whether it computes on the CPU.
    pub software: bool,
    /// Whether it is used when no adapter is named.
    pub default: bool,
    /// Limits that decide what fits.
    pub limits: Limits,
}

/// The limits that decide which scenes fit.
#[derive(Debug, Serialize)]
pub struct Limits {
    /// Bytes of one storage binding.
    pub storage_binding_bytes: u64,
    /// Bytes of one buffer.
    pub buffer_bytes: u64,
    /// Storage buffers of one kernel.
    pub storage_buffers: u32,
    /// Invocations of one workgroup.
    pub workgroup_invocations: u32,
    /// Workgroups along one dimension of a dispatch.
    pub workgroups: u32,
}

impl Adapter {
    /// The properties that `adapter` reports.
    pub fn of(adapter: &wgpu::Adapter, default: bool) -> Self {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        Self {
            driver: format!("{} {}", info.driver, info.driver_info)
                .trim()
                .to_owned(),
            backend: format!("{:?}", info.backend),
            kind: format!("{:?}", info.device_type),
            software: gpu::is_software(&info),
            name: info.name,
            default,
            limits: Limits {
                storage_binding_bytes: limits.max_storage_buffer_binding_size,
                buffer_bytes: limits.max_buffer_size,
                storage_buffers: limits.max_storage_buffers_per_shader_stage,
                workgroup_invocations: limits.max_compute_invocations_per_workgroup,
                workgroups: limits.max_compute_workgroups_per_dimension,
            },
        }
    }
}

/// Prints the adapters.
pub fn run(args: &Args) -> Result<()> {
    let found = gpu::adapters();
    if found.is_empty() {
        return Err(Error::Device(gpu::HINT.into()).into());
    }
    let all: Vec<_> = found
        .iter()
        .enumerate()
        .map(|(order, adapter)| Adapter::of(adapter, order == 0))
        .collect();
    if args.json {
        return print::print_json(&all);
    }
    let mut text = String::new();
    for (order, adapter) in (1..).zip(&all) {
        let limits = &adapter.limits;
        let default = if adapter.default { ", the default" } else { "" };
        writeln!(text, "{order}. {}{default}", adapter.name)?;
        writeln!(
            text,
            "   {}, {}, {}",
            adapter.backend, adapter.kind, adapter.driver
        )?;
        writeln!(
            text,
            "   {} storage buffers of {}, buffers of {}, workgroups of {}, {} of them in a row",
            limits.storage_buffers,
            print::bytes(limits.storage_binding_bytes),
            print::bytes(limits.buffer_bytes),
            limits.workgroup_invocations,
            limits.workgroups,
        )?;
    }
    print::print(&text)
}
