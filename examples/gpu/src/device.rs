use std::{
    collections::HashMap,
    fmt,
    sync::{Arc, Mutex, PoisonError},
};

use wgpu::{
    Adapter, Backends, ComputePipeline, DeviceDescriptor, Instance, InstanceDescriptor, Limits, PollType, Queue,
};

use crate::shader::Shader;

/// No GPU that can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoAdapter {
    /// There is none at all.
    None,
    /// None of this name.
    Named {
        /// The name.
        name: String,
        /// Those that there are.
        others: Vec<String>,
    },
    /// It refused to be opened.
    Refused {
        /// Which.
        name: String,
        /// Why.
        reason: String,
    },
}

impl fmt::Display for NoAdapter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => {
                write!(
                    f,
                    "no GPU: install a driver for Vulkan; lavapipe (mesa-vulkan-drivers) is one for any processor"
                )
            }
            Self::Named { name, others } => write!(f, "no GPU is called {name:?}: name one of {}", others.join(", ")),
            Self::Refused { name, reason } => write!(f, "{name}: {reason}: choose another one with --adapter"),
        }
    }
}

impl std::error::Error for NoAdapter {}

/// An opened GPU.
#[derive(Clone, Debug)]
pub struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: Queue,
    name: String,
    /// What was compiled for it: that takes seconds.
    pipelines: Arc<Mutex<HashMap<Shader, ComputePipeline>>>,
}

fn adapters() -> Vec<Adapter> {
    let instance = Instance::new(InstanceDescriptor {
        backends: Backends::VULKAN,
        ..InstanceDescriptor::new_without_display_handle_from_env()
    });
    pollster::block_on(instance.enumerate_adapters(Backends::VULKAN))
}

fn describe(adapter: &Adapter) -> String {
    let info = adapter.get_info();
    format!("{} ({:?}, {:?})", info.name, info.backend, info.device_type)
}

impl Device {
    /// The names of all there are.
    #[must_use]
    pub fn list() -> Vec<String> {
        adapters().iter().map(describe).collect()
    }

    /// Opens the first whose name contains `name`, or else the one that is likely the fastest.
    ///
    /// # Errors
    ///
    /// [`NoAdapter`].
    pub fn open(name: Option<&str>) -> Result<Self, NoAdapter> {
        let mut all = adapters();
        let others: Vec<String> = all.iter().map(describe).collect();
        // Separate ones before those in a processor, processors last.
        all.sort_by_key(|adapter| match adapter.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        });
        if all.is_empty() {
            return Err(NoAdapter::None);
        }
        let wanted =
            |adapter: &Adapter| name.is_none_or(|name| describe(adapter).to_lowercase().contains(&name.to_lowercase()));
        let adapter = all.into_iter().find(wanted);
        let adapter = adapter.ok_or_else(|| NoAdapter::Named { name: name.unwrap_or_default().to_owned(), others })?;
        let name = describe(&adapter);
        let has = adapter.limits();
        // The most that it has of what scenes are large by, and of nothing else more than every GPU has.
        let limits = Limits {
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            max_buffer_size: has.max_buffer_size,
            ..Limits::default()
        };
        let descriptor = DeviceDescriptor { required_limits: limits, ..DeviceDescriptor::default() };
        match pollster::block_on(adapter.request_device(&descriptor)) {
            Ok((device, queue)) => Ok(Self { device, queue, name, pipelines: Arc::default() }),
            Err(error) => Err(NoAdapter::Refused { name, reason: error.to_string() }),
        }
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The most bytes that one binding may have.
    #[must_use]
    pub fn binding(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// Waits until everything that was submitted is done.
    pub(crate) fn wait(&self) {
        // Fails only for a submission of another device.
        let _ = self.device.poll(PollType::wait_indefinitely());
    }

    /// A shader, compiled.
    pub(crate) fn pipeline(&self, shader: &Shader) -> ComputePipeline {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        pipelines.entry(*shader).or_insert_with(|| shader.compile(&self.device)).clone()
    }
}
