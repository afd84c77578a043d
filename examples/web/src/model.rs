use hitscan::{
    geometry::{Aabb, Sphere},
    glam::Vec3,
    render::Material,
};

/// What is drawn: triangles and balls, with materials.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Corners.
    pub vertices: Vec<Vec3>,
    /// A normal for each vertex, zero where triangles are meant to be flat.
    pub normals: Vec<Vec3>,
    /// Three numbers of vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// Balls, numbered after the triangles.
    pub spheres: Vec<Sphere>,
    /// The materials that there are.
    pub palette: Vec<Material>,
    /// Which is whose.
    pub numbers: Vec<u16>,
    /// What the camera looks at; everything if empty.
    pub focus: Option<Aabb>,
    /// The axis that points up: 2 for z, else y.
    pub up: u32,
}

impl Model {
    /// What a mesh without materials is made of.
    pub const GLAZED: Material =
        Material::matte(Vec3::new(0.66, 0.60, 0.52)).with_highlights(0.35, 60.0).with_reflectivity(0.08);

    /// What it stands on.
    const PLATE: Material =
        Material::matte(Vec3::new(0.28, 0.30, 0.32)).with_highlights(0.1, 40.0).with_reflectivity(0.12);

    /// Up, and two directions along the ground.
    #[must_use]
    pub const fn axes(&self) -> [Vec3; 3] {
        // Where z is up, y points away from the viewer.
        if self.up == 2 { [Vec3::Z, Vec3::X, Vec3::NEG_Y] } else { [Vec3::Y, Vec3::X, Vec3::Z] }
    }

    /// Adds triangles of one material, their corners counted from the first of `points`, each with its normal.
    pub fn push(&mut self, points: &[(Vec3, Vec3)], triangles: &[[u32; 3]], material: Material) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(points.iter().map(|(point, _)| *point));
        self.normals.extend(points.iter().map(|(_, normal)| *normal));
        self.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        let number = self.number(material);
        self.numbers.resize(self.triangles.len(), number);
    }

    /// Adds a ball; triangles cannot follow.
    pub fn push_sphere(&mut self, sphere: Sphere, material: Material) {
        self.spheres.push(sphere);
        let number = self.number(material);
        self.numbers.push(number);
    }

    fn number(&mut self, material: Material) -> u16 {
        let known = self.palette.iter().position(|other| *other == material);
        let number = known.unwrap_or_else(|| {
            self.palette.push(material);
            self.palette.len() - 1
        });
        u16::try_from(number).unwrap_or(u16::MAX)
    }

    /// The same with a plate below, on which shadows fall.
    #[must_use]
    pub fn on_the_ground(mut self) -> Self {
        let used = self.triangles.iter().flatten().filter_map(|&corner| self.vertices.get(corner as usize));
        let bounds = Aabb::around(used.copied());
        let [up, right, front] = self.axes();
        let (center, size) = (bounds.center(), bounds.size());
        let reach = size.length() * 0.75;
        let below = center - up * (size.dot(up).abs() * 0.5 + reach * 1.0e-4);
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
            .map(|(x, z)| (below + (right * x + front * z) * reach, Vec3::ZERO));
        self.focus = Some(bounds);
        self.push(&corners, &[[0, 1, 2], [0, 2, 3]], Self::PLATE);
        self
    }
}
