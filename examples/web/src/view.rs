use hitscan::render::Terms;

/// What of a scene is drawn, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// How far the viewer went around, to the right, in radians.
    pub yaw: f32,
    /// How far the viewer went up, in radians.
    pub pitch: f32,
    /// How near the viewer went.
    pub zoom: f32,
    /// Terms of light, a bit each: ambient, diffuse, specular, shadows, reflections.
    pub terms: u32,
    /// Mirror images in mirror images.
    pub bounces: u32,
    /// Rays along a side of a pixel in the end.
    pub samples: u32,
    /// Nodes visited instead of colours.
    pub heat: bool,
}

impl View {
    /// The most pixels along a side, rays along a side of a pixel, and bounces.
    const MOST: [u32; 3] = [2048, 8, 16];

    /// The same within bounds.
    #[must_use]
    pub fn sane(self) -> Self {
        let [side, samples, bounces] = Self::MOST;
        let finite = |x: f32, otherwise: f32| if x.is_finite() { x } else { otherwise };
        Self {
            width: self.width.min(side),
            height: self.height.min(side),
            yaw: finite(self.yaw, 0.0),
            pitch: finite(self.pitch, 0.0).clamp(-1.5, 1.5),
            zoom: finite(self.zoom, 1.0).clamp(0.05, 50.0),
            bounces: self.bounces.min(bounces),
            // Nodes are counted for one ray through the middle of the pixel, and what follows from it.
            samples: if self.heat { 1 } else { self.samples.clamp(1, samples) },
            ..self
        }
    }

    /// The terms of light.
    #[must_use]
    pub fn terms(&self) -> Terms {
        let has = |bit: u32| self.terms >> bit & 1 == 1;
        Terms { ambient: has(0), diffuse: has(1), specular: has(2), shadows: has(3), reflections: has(4) }
    }
}
