use std::time::Instant;

use anyhow::{Result, bail};
use bytemuck::{Pod, Zeroable};
use hitscan::{Ray, asset::Asset};
use wgpu::{
    BindGroupDescriptor, BindGroupEntry, Buffer, BufferDescriptor, BufferUsages, CommandEncoderDescriptor,
    ComputePassDescriptor, ComputePipeline, MapMode,
};

use crate::{
    device::Device,
    layout::{Layout, Part},
    shader::{MOST_BINDINGS, Purpose, Shader, WORDS},
};

/// Invocations in a workgroup, as the shaders have it.
const GROUP: u32 = 64;

/// Rays per dispatch: enough to fill any GPU, and not so many that a system takes it for dead.
const BATCH: usize = 1 << 20;

/// What is asked of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// The closest hit.
    Closest,
    /// Whether there is one.
    Any,
}

/// What a shader says of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Answer {
    found: u32,
    work: u32,
}

impl Answer {
    const NONE: u32 = u32::MAX;
    const UNSURE: u32 = u32::MAX - 1;

    /// Whether it is certain.
    #[must_use]
    pub const fn is_certain(self) -> bool {
        self.found != Self::UNSURE
    }

    /// The place in the asset of the primitive that is hit; for [`Query::Any`], of one that is.
    #[must_use]
    pub const fn place(self) -> Option<u32> {
        if self.found == Self::NONE || self.found == Self::UNSURE { None } else { Some(self.found) }
    }

    /// Nodes that were looked at.
    #[must_use]
    pub const fn nodes(self) -> u32 {
        self.work & 0xffff
    }

    /// Primitives that were tested.
    #[must_use]
    pub const fn tests(self) -> u32 {
        self.work >> 16
    }
}

/// A ray as shaders have it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Record {
    origin: [f32; 3],
    t_min: f32,
    direction: [f32; 3],
    t_max: f32,
}

impl From<&Ray> for Record {
    fn from(ray: &Ray) -> Self {
        // Rays that do not see everything are the library's: no shader takes a NaN.
        let t_min = if ray.mask == u32::MAX { ray.t_min } else { f32::NAN };
        Self { origin: ray.origin.to_array(), t_min, direction: ray.direction.to_array(), t_max: ray.t_max }
    }
}

/// An asset's words in a GPU's memory.
#[derive(Debug)]
pub struct Uploaded {
    pub(crate) device: Device,
    pub(crate) layout: Layout,
    pub(crate) parts: Buffer,
    words: Vec<Buffer>,
    /// The binary logarithm of the pairs of words in a binding.
    shift: u32,
    rough: bool,
}

impl Uploaded {
    /// Uploads the words of an asset, as they are, in bindings of at most `binding` bytes or what the device allows.
    ///
    /// # Errors
    ///
    /// If the asset is not for shaders ([`Unfit`](crate::Unfit)), or too large.
    pub fn new(device: &Device, asset: &Asset<'_>, binding: Option<u64>) -> Result<Self> {
        let layout = Layout::of(asset)?;
        let words = asset.as_words();
        let bytes = words.len() as u64 * 4;
        let most = binding.map_or(device.binding(), |binding| binding.min(device.binding()));
        // Pairs of words, a power of two of them.
        let shift = (most / 8).max(1).ilog2().min(31);
        let piece = 1_usize << (shift + 1);
        let pieces: Vec<&[u32]> = words.chunks(piece).collect();
        if pieces.len() > MOST_BINDINGS {
            let room = (piece * 4 * MOST_BINDINGS) as u64;
            bail!("it has {bytes} bytes, and this GPU takes {room}: bake it with `--lattice`, or choose another GPU");
        }
        let buffer = |contents: &[u8], usage| {
            let size = (contents.len() as u64).next_multiple_of(8).max(8);
            let descriptor = BufferDescriptor {
                label: None,
                size,
                usage: usage | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            };
            let buffer = device.device.create_buffer(&descriptor);
            device.queue.write_buffer(&buffer, 0, contents);
            buffer
        };
        let words: Vec<Buffer> =
            pieces.iter().map(|piece| buffer(bytemuck::cast_slice(piece), BufferUsages::STORAGE)).collect();
        let parts = buffer(bytemuck::cast_slice(&layout.parts), BufferUsages::STORAGE);
        Ok(Self { device: device.clone(), layout, parts, words, shift, rough: false })
    }

    /// The same with shaders that are an ulp off at each step, as another GPU may be: answers must be the same, but for more
    /// that are not certain.
    #[must_use]
    pub fn roughly(self) -> Self {
        Self { rough: true, ..self }
    }

    /// Bindings that the words take.
    #[must_use]
    pub fn bindings(&self) -> usize {
        self.words.len()
    }

    /// What the shaders make of rays.
    #[must_use]
    pub fn cast(&self, rays: &[Ray], query: Query) -> Vec<Answer> {
        let mut answers = Vec::with_capacity(rays.len());
        for batch in rays.chunks(BATCH) {
            let prepared = self.prepare(batch);
            self.dispatch(&prepared, query);
            answers.extend(bytemuck::cast_slice::<_, Answer>(&self.read(&prepared.answers)));
        }
        answers
    }

    /// The seconds that the shader alone takes for rays that are on the GPU already.
    pub(crate) fn seconds(&self, rays: &[Ray], query: Query) -> f64 {
        let timed = |batch| {
            let prepared = self.prepare(batch);
            self.device.queue.submit([]);
            self.device.wait();
            let begun = Instant::now();
            self.dispatch(&prepared, query);
            begun.elapsed().as_secs_f64()
        };
        rays.chunks(BATCH).map(timed).sum()
    }

    /// Bytes that a node and a primitive take to read; of placed scenes, those of the last part.
    pub(crate) fn traffic(&self) -> (f64, f64) {
        self.layout.parts.last().map_or((0.0, 0.0), Part::traffic)
    }

    /// Uploads a batch of rays.
    pub(crate) fn prepare(&self, rays: &[Ray]) -> Batch {
        let records: Vec<Record> = rays.iter().map(Record::from).collect();
        let input = self.buffer(size_of_val(&*records), BufferUsages::STORAGE | BufferUsages::COPY_DST);
        self.device.queue.write_buffer(&input, 0, bytemuck::cast_slice(&records));
        let answers = self.buffer(rays.len() * size_of::<Answer>(), BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        Batch { input, answers, rays: rays.len() as u32 }
    }

    /// Casts a batch and waits for it.
    pub(crate) fn dispatch(&self, batch: &Batch, query: Query) {
        let pipeline = self.compiled(match query {
            Query::Closest => Purpose::Closest,
            Query::Any => Purpose::Any,
        });
        self.run(&pipeline, &batch.input, &batch.answers, (batch.rays.div_ceil(GROUP), 1));
    }

    pub(crate) fn buffer(&self, bytes: usize, usage: BufferUsages) -> Buffer {
        let size = (bytes as u64).max(8);
        self.device.device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    }

    /// Runs a shader over what it reads and what it writes.
    pub(crate) fn run(&self, pipeline: &ComputePipeline, input: &Buffer, output: &Buffer, groups: (u32, u32)) {
        let device = &self.device.device;
        let fixed = [&self.parts, input, output];
        let entries: Vec<BindGroupEntry<'_>> = fixed
            .into_iter()
            .chain(&self.words)
            .zip(0..)
            .map(|(buffer, binding)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        debug_assert_eq!(fixed.len(), WORDS as usize);
        let layout = pipeline.get_bind_group_layout(0);
        let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(groups.0, groups.1, 1);
        }
        self.device.queue.submit([encoder.finish()]);
        self.device.wait();
    }

    /// The contents of a buffer.
    pub(crate) fn read(&self, buffer: &Buffer) -> Vec<u8> {
        let staging = self.buffer(buffer.size() as usize, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let mut encoder = self.device.device.create_command_encoder(&CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
        self.device.queue.submit([encoder.finish()]);
        staging.map_async(MapMode::Read, .., |_| {});
        self.device.wait();
        staging.get_mapped_range(..).map_or_else(|_| Vec::new(), |view| view.to_vec())
    }

    /// The shader of a purpose for this scene.
    pub(crate) fn compiled(&self, purpose: Purpose) -> ComputePipeline {
        let Layout { structures, placed, .. } = self.layout;
        let (bindings, shift) = (self.words.len(), if self.words.len() > 1 { self.shift } else { 0 });
        self.device.pipeline(&Shader { purpose, structures, placed, bindings, shift, rough: self.rough })
    }
}

/// Rays and room for their answers.
#[derive(Debug)]
pub(crate) struct Batch {
    input: Buffer,
    pub(crate) answers: Buffer,
    rays: u32,
}
