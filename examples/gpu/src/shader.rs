//! The shaders' text: the files, and how the words are found in their bindings.

use std::fmt::Write as _;

use wgpu::{
    ComputePipeline, ComputePipelineDescriptor, PipelineCompilationOptions, ShaderModuleDescriptor, ShaderSource,
};

/// The first binding of the words.
pub(crate) const WORDS: u32 = 3;

/// The most bindings of words: of the eight that every GPU has, three are taken.
pub(crate) const MOST_BINDINGS: usize = 5;

/// What a shader is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Purpose {
    /// The closest hits of a batch.
    Closest,
    /// Whether the rays of a batch hit anything.
    Any,
    /// A picture.
    Render,
}

/// A shader: for what, and over what it is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Shader {
    pub(crate) purpose: Purpose,
    /// A bit per kind of structure.
    pub(crate) structures: u32,
    /// Whether the scene is of placed parts.
    pub(crate) placed: bool,
    /// In how many bindings the words are, of 2^`shift` pairs each.
    pub(crate) bindings: usize,
    pub(crate) shift: u32,
    /// Whether each step is an ulp off.
    pub(crate) rough: bool,
}

impl Shader {
    /// Where the words are.
    fn bindings(&self) -> String {
        let (mut text, mut cases) = (String::new(), String::new());
        for (index, binding) in (0..self.bindings).zip(WORDS..) {
            let _ = writeln!(text, "@group(0) @binding({binding}) var<storage, read> words{index}: array<vec2<u32>>;");
            let _ = writeln!(cases, "case {index}u: {{ return words{index}[at]; }}");
        }
        let (shift, mask) = (self.shift, (1_u64 << self.shift) - 1);
        let body = match self.bindings {
            1 => "return words0[index];".to_owned(),
            _ => format!(
                "let at = index & {mask}u;\nswitch index >> {shift}u {{\n{cases}default: {{ return vec2(0u); }}\n}}"
            ),
        };
        text + "fn pair(index: u32) -> vec2<u32> {\n" + &body + "\n}\n"
    }

    /// All of it.
    fn text(&self) -> String {
        let own = match self.purpose {
            Purpose::Closest | Purpose::Any => include_str!("../shaders/cast.wgsl"),
            Purpose::Render => include_str!("../shaders/render.wgsl"),
        };
        [
            &self.bindings(),
            include_str!("../shaders/scene.wgsl"),
            include_str!("../shaders/line.wgsl"),
            include_str!("../shaders/triangle.wgsl"),
            include_str!("../shaders/walk.wgsl"),
            include_str!("../shaders/search.wgsl"),
            own,
        ]
        .concat()
    }

    /// Compiles it.
    pub(crate) fn compile(&self, device: &wgpu::Device) -> ComputePipeline {
        let (entry, any) = match self.purpose {
            Purpose::Closest => ("cast_rays", Some(0.0)),
            Purpose::Any => ("cast_rays", Some(1.0)),
            Purpose::Render => ("render", None),
        };
        let source = ShaderSource::Wgsl(self.text().into());
        let module = device.create_shader_module(ShaderModuleDescriptor { label: Some(entry), source });
        let switch = |on: bool| f64::from(u8::from(on));
        let scene = [
            ("STRUCTURES", f64::from(self.structures)),
            ("PLACED", switch(self.placed)),
            ("ROUGH", switch(self.rough)),
        ];
        let constants: Vec<(&str, f64)> = scene.into_iter().chain(any.map(|any| ("ANY", any))).collect();
        device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        })
    }
}
