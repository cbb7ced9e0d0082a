//! Results of a workspace.

use super::conditions::ConditionRow;
use super::places::{PlaneOfMotion, THICKNESS};
use crate::analyses::fields::AXES;
use crate::analyses::found;
use crate::analyses::prove::Proved;
use crate::columns::{ResultTable, Tabled, parts};
use crate::rows::rows;
use crate::table::Column;
use crate::text::{counted, significant};
use funicular::level_set::{
    BOX_FACES, BoundaryMesh, LevelSet, PointGrid, RaySet, RaysInBox, SearchEnd, SetPart, signed_area,
};
use funicular::math::{Rotation, Vec3, rotation};

/// Error of the volume, over the volume, above which the grid counts as too coarse.
const COARSE: f64 = 0.03;

rows! {
    /// Results of `workspace`.
    pub struct Workspace {
        pub robot: String = hidden;
        pub static_model: &'static str;
        pub conditions: Vec<ConditionRow>;
        /// Roll, pitch and yaw of every orientation, and which of them have to be possible: `all` or `some`.
        pub roll_pitch_yaw_deg: Vec<[f64; 3]>;
        pub orientations: &'static str;
        /// Plane of a planar platform, in which the set is an area; absent in space. Volumes are those of a slab of 1
        /// m.
        pub plane: Option<AreaOfWorkspace>;
        pub grid: GridOfWorkspace;
        /// True if everything was found: otherwise the work was stopped before the steps were as small as requested, or
        /// before the vertices had their places.
        pub complete: bool;
        /// Number of positions that were evaluated.
        pub evaluations: usize;
        /// Volumes: with the steps of the grid, with two and four of them as one, and along rays.
        pub volumes: Vec<VolumeRow>;
        /// Parts that do not touch each other, and holes, the largest first.
        pub parts: Vec<PartOfWorkspace>;
        pub holes: Vec<PartOfWorkspace>;
        /// Faces of the box up to which the set reaches: it may go on behind them.
        pub touches: Vec<&'static str>;
        /// Area in which the faces of the box cut the set.
        pub cut_area_m2: f64;
        /// Smallest box around the set.
        pub bounds_m: [[f64; 3]; 2];
        /// Largest box whose nodes are all in the set.
        pub inner_box: Option<InnerBox>;
        pub sections: Vec<SectionOfWorkspace>;
        pub rays: Option<RaysOfWorkspace>;
        /// Comparison with another robot.
        pub compared: Option<ComparedSets>;
        /// Proof in which parts of the box required loads are held.
        pub proof: Option<Proved>;
        /// Closed surface: vertices, and triangles by the numbers of their vertices from 0, counterclockwise from
        /// outside.
        pub vertices_m: Vec<[f64; 3]>;
        pub triangles: Vec<[usize; 3]>;
        /// Number of triangles on the surface of the set; those after them lie on the faces of the box.
        pub triangles_of_surface: usize;
        /// Anchors of the cables, for figures.
        pub anchors: Vec<Vec3> = hidden;
        pub warnings: Vec<String> = hidden;
    }
}

rows! {
    /// Set of a planar platform.
    pub struct AreaOfWorkspace {
        /// Axis at right angles to the plane, and coordinate of the plane.
        pub axis: &'static str;
        pub at_m: f64;
        pub area_m2: f64;
        /// Numbers of parts that do not touch each other, and of holes.
        pub parts: usize;
        pub holes: usize;
    }
}

impl AreaOfWorkspace {
    /// Set in a plane, from the slab that stands for it and its section.
    fn of(plane: PlaneOfMotion, slab: &BoundaryMesh) -> Self {
        let section = slab.section(plane.axis, plane.at);
        let (parts, holes): (Vec<_>, Vec<_>) =
            section.polygons.iter().partition(|polygon| signed_area(polygon, plane.axis) > 0.0);
        Self {
            axis: AXES[plane.axis],
            at_m: plane.at,
            area_m2: slab.volume() / THICKNESS,
            parts: parts.len(),
            holes: holes.len(),
        }
    }
}

rows! {
    /// Grid on which a set was found.
    pub struct GridOfWorkspace {
        pub lower_m: [f64; 3];
        pub upper_m: [f64; 3];
        /// Step along each axis.
        pub step_m: [f64; 3];
        /// Largest step with which the set was searched at first: separate parts and holes that are smaller can be
        /// missed.
        pub first_step_m: f64;
        pub vertex_tolerance_m: f64;
    }
}

rows! {
    /// Volume of the set with what it was found with.
    pub struct VolumeRow in tables() {
        /// Grid, rays, or hull of rays.
        ///
        /// `grid`, `rays` (all intervals of all rays) or `hull of rays` (triangles between their first ends).
        pub by: &'static str => one.plain("by");
        /// Largest step of the grid, or between points of a ray.
        pub step_m: f64 => one.short("step", 4);
        /// Number of rays.
        pub rays: Option<usize> => one.plain("rays");
        /// Volume of the set.
        pub volume_m3: f64 => one.significant("volume", 6);
        /// Largest expected error of the volume.
        ///
        /// Largest error that the volume is expected to have, by what the steps and points between the nodes leave
        /// open.
        pub volume_error_m3: Option<f64> => one.significant("error", 2);
        /// Area of its surface.
        pub area_m2: Option<f64>
            => one.significant("area", 6)
            => parts("centroid_{}_m", AXES, "m", "centroid of its volume, {}", |row: &Self| {
                row.centroid_m.map_or([None; 3], |centroid| centroid.map(Some))
            })
            .decimals("centroid", 3);
        pub centroid_m: Option<[f64; 3]>;
        /// Number of parts that do not touch each other.
        pub parts: Option<usize> => one.plain("parts");
        /// Number of holes that the outside does not reach.
        pub holes: Option<usize> => one.plain("holes");
        /// Number of handles of all surfaces, 1 for a ring.
        ///
        /// Number of handles of all surfaces: 0 for balls, 1 for a ring.
        pub handles: Option<usize> => one.plain("handles");
    }
}

rows! {
    /// Part of a set, or a hole in it.
    pub struct PartOfWorkspace {
        /// Volume; that of a part includes its holes.
        pub volume_m3: f64;
        pub handles: usize;
    }
}

rows! {
    /// Box inside a set.
    pub struct InnerBox {
        pub lower_m: [f64; 3];
        pub upper_m: [f64; 3];
        pub volume_m3: f64;
    }
}

rows! {
    /// Section of a set.
    pub struct SectionOfWorkspace {
        pub axis: &'static str;
        pub at_m: f64;
        pub area_m2: f64;
        /// Closed polygons: counterclockwise around the set, clockwise around holes.
        pub polygons_m: Vec<Vec<[f64; 3]>>;
    }
}

rows! {
    /// Set along rays.
    pub struct RaysOfWorkspace {
        pub center_m: [f64; 3];
        pub count: usize;
        /// Rays with more than one interval: the set is not star-shaped from the centre.
        pub with_several_intervals: usize;
        /// Rays along which the set reaches the box.
        pub cut: usize;
        /// Unit vector of every ray, and the distances from the centre between which it is in the set.
        pub directions: Vec<[f64; 3]>;
        pub intervals_m: Vec<Vec<[f64; 2]>>;
        volumes: Vec<VolumeRow> = hidden;
        evaluations: usize = hidden;
    }
}

rows! {
    /// Volumes of two sets on one grid, and of what they share.
    pub struct ComparedSets {
        /// Name of the other robot.
        pub other: String;
        pub other_volume_m3: f64;
        pub common_volume_m3: f64;
        /// Volume that only this robot reaches, and that only the other one reaches.
        pub only_own_m3: f64;
        pub only_other_m3: f64;
        evaluations: usize = hidden;
    }
}

impl ComparedSets {
    pub(super) fn of(other: &str, [own, of_other, common]: [f64; 3], evaluations: usize) -> Self {
        Self {
            other: other.to_owned(),
            other_volume_m3: of_other,
            common_volume_m3: common,
            only_own_m3: own - common,
            only_other_m3: of_other - common,
            evaluations,
        }
    }
}

/// Conditions and grid of a search, apart from the found set.
pub(super) struct WantedSet<'a> {
    pub(super) robot: &'a str,
    pub(super) anchors: Vec<Vec3>,
    pub(super) static_model: &'static str,
    pub(super) conditions: &'a [ConditionRow],
    pub(super) orientations: (&'a [Rotation], &'static str),
    /// Tolerance of the vertices [m].
    pub(super) tolerance: f64,
    /// Number of the axis and coordinate of each section.
    pub(super) sections: &'a [(usize, f64)],
    /// True if the set is wanted along rays, and if it is compared with another one.
    pub(super) with_rays: bool,
    pub(super) with_other: bool,
    /// Plane of a planar platform.
    pub(super) plane: Option<PlaneOfMotion>,
}

impl Workspace {
    /// Results of a search on the grid, and along rays.
    pub(super) fn of(
        wanted: &WantedSet<'_>,
        set: &LevelSet,
        surface: &BoundaryMesh,
        mut rays: Option<RaysOfWorkspace>,
        compared: Option<ComparedSets>,
    ) -> Self {
        let strides = set.strides();
        let step = |stride: usize| largest_step(set.grid(), wanted.plane) * stride as f64;
        let finest = VolumeRow::of_grid(surface, step(strides[0]));
        let coarser = strides[1..].iter().map(|stride| VolumeRow::of_grid(&set.boundary(*stride), step(*stride)));
        let mut volumes: Vec<VolumeRow> = std::iter::once(finest).chain(coarser).collect();
        for (row, error) in volumes.iter_mut().zip(set.volume_errors()) {
            row.volume_error_m3 = Some(error);
        }
        volumes.extend(rays.as_mut().into_iter().flat_map(|rays| std::mem::take(&mut rays.volumes)));

        // The slab of a planar platform ends at its faces, which are no border of the set.
        let beside = |face: &str| wanted.plane.is_some_and(|plane| face.ends_with(AXES[plane.axis]));
        let touches = BOX_FACES.into_iter().zip(set.touches());
        let touches = touches.filter(|(face, touches)| *touches && !beside(face)).map(|(face, _)| face).collect();
        let of_faces = wanted.plane.map_or(0.0, |_| 2.0 * surface.volume() / THICKNESS);
        let grid = set.grid();
        let in_plane = |corner: Vec3| wanted.plane.map_or(corner, |plane| plane.project(corner));
        let bounds = surface.bounds().unwrap_or([Vec3::zeros(); 2]).map(in_plane);
        let section = |(axis, at): &(usize, f64)| SectionOfWorkspace::of(surface, *axis, *at);
        Self {
            robot: wanted.robot.to_owned(),
            static_model: wanted.static_model,
            conditions: wanted.conditions.to_vec(),
            roll_pitch_yaw_deg: wanted.orientations.0.iter().map(rotation::to_roll_pitch_yaw_deg).collect(),
            orientations: wanted.orientations.1,
            plane: wanted.plane.map(|plane| AreaOfWorkspace::of(plane, surface)),
            grid: GridOfWorkspace {
                lower_m: grid.lower().into(),
                upper_m: grid.upper().into(),
                step_m: (grid.step() * strides[0] as f64).into(),
                first_step_m: first_step(grid, wanted.plane),
                vertex_tolerance_m: wanted.tolerance,
            },
            complete: set.end() == SearchEnd::Complete
                && rays.is_some() == wanted.with_rays
                && compared.is_some() == wanted.with_other,
            evaluations: set.evaluations()
                + rays.as_ref().map_or(0, |rays| rays.evaluations)
                + compared.as_ref().map_or(0, |compared| compared.evaluations),
            volumes,
            parts: surface.parts().into_iter().map(PartOfWorkspace::of).collect(),
            holes: surface.holes().into_iter().map(PartOfWorkspace::of).collect(),
            touches,
            cut_area_m2: (surface.cut_area() - of_faces).max(0.0),
            bounds_m: bounds.map(Into::into),
            inner_box: set.inner_box().filter(|_| wanted.plane.is_none()).map(InnerBox::of),
            sections: wanted.sections.iter().map(section).collect(),
            rays,
            compared,
            proof: None,
            vertices_m: surface.vertices().iter().map(|vertex| (*vertex).into()).collect(),
            triangles: surface.triangles().to_vec(),
            triangles_of_surface: surface.on_surface(),
            anchors: wanted.anchors.clone(),
            warnings: Vec::new(),
        }
    }

    /// Volume with the smallest steps.
    pub fn volume(&self) -> &VolumeRow {
        &self.volumes[0]
    }

    /// Volume with two steps as one, if there is one.
    pub fn with_double_steps(&self) -> Option<&VolumeRow> {
        self.volumes.get(1).filter(|row| row.rays.is_none())
    }

    /// Largest expected error of the volume over the volume, or of the area of a planar platform; `None` without a
    /// volume.
    pub fn relative_error(&self) -> Option<f64> {
        let fine = self.volume();
        fine.volume_error_m3.map(|error| error / fine.volume_m3).filter(|error| error.is_finite())
    }

    /// Sentences about what the grid leaves open.
    pub(super) fn doubts(&self) -> Vec<String> {
        let stopped = (!self.complete).then(|| {
            let message = "the work was stopped: this is what was found until then";
            message.to_owned()
        });
        let alone = "parts and holes were not compared with those of larger steps: make the number of steps along \
                     every axis of ⟪grid⟫ a multiple of 4, as with 41 values";
        let pieces = match self.with_double_steps() {
            Some(coarse) => self.other_pieces(coarse),
            None => Some(alone.to_owned()),
        };
        stopped.into_iter().chain(self.coarse_volume()).chain(pieces).chain(self.cut_by_box()).collect()
    }

    /// Sentence about a volume that the steps leave open.
    fn coarse_volume(&self) -> Option<String> {
        let error = self.relative_error()?;
        let message = format!(
            "the grid is coarse for this set: with steps of {} m its volume is sure to {} % only; halve the steps",
            significant(self.volume().step_m, 4),
            significant(100.0 * error, 2)
        );
        (error > COARSE).then_some(message)
    }

    /// Sentence about parts, holes and handles that are others with double steps.
    fn other_pieces(&self, coarse: &VolumeRow) -> Option<String> {
        let fine = self.volume();
        let counts = |row: &VolumeRow| (row.parts, row.holes, row.handles);
        let message = format!(
            "the number of parts, holes or handles depends on the grid: {} with steps of {} m, {} with steps of {} m; \
             halve the steps",
            pieces(fine),
            significant(fine.step_m, 4),
            pieces(coarse),
            significant(coarse.step_m, 4)
        );
        (counts(fine) != counts(coarse)).then_some(message)
    }

    /// Sentence about a set that reaches the box of the grid.
    fn cut_by_box(&self) -> Option<String> {
        let message = format!(
            "the set reaches the box of the grid at {}: it may go on there; give a larger ⟪grid⟫",
            self.touches.join(", ")
        );
        (!self.touches.is_empty()).then_some(message)
    }
}

/// Largest step of a grid along the axes that the platform has [m].
fn largest_step(grid: &PointGrid, plane: Option<PlaneOfMotion>) -> f64 {
    let has = |k: &usize| plane.is_none_or(|plane| plane.axis != *k);
    (0..3).filter(has).map(|k| grid.step()[k]).fold(0.0, f64::max)
}

/// Largest step with which a grid is searched at first [m].
pub(super) fn first_step(grid: &PointGrid, plane: Option<PlaneOfMotion>) -> f64 {
    largest_step(grid, plane) * grid.largest_stride() as f64
}

/// Numbers of parts, holes and handles for the middle of a sentence.
fn pieces(row: &VolumeRow) -> String {
    let count = |number: Option<usize>, noun: &str| counted(number.unwrap_or(0), noun);
    format!("{}, {} and {}", count(row.parts, "part"), count(row.holes, "hole"), count(row.handles, "handle"))
}

impl VolumeRow {
    fn of_grid(mesh: &BoundaryMesh, step_m: f64) -> Self {
        let (parts, holes) = (mesh.parts(), mesh.holes());
        Self {
            by: "grid",
            step_m,
            rays: None,
            volume_m3: mesh.volume(),
            volume_error_m3: None,
            area_m2: Some(mesh.area()),
            centroid_m: mesh.centroid().map(Into::into),
            parts: Some(parts.len()),
            holes: Some(holes.len()),
            handles: Some(parts.iter().chain(&holes).map(|piece| piece.handles).sum()),
        }
    }

    fn of_rays(by: &'static str, rays: usize, step_m: f64, volume_m3: f64, hull: Option<&BoundaryMesh>) -> Self {
        let area_m2 = hull.map(BoundaryMesh::area);
        let centroid_m = hull.and_then(BoundaryMesh::centroid).map(Into::into);
        Self {
            by,
            step_m,
            rays: Some(rays),
            volume_m3,
            volume_error_m3: None,
            area_m2,
            centroid_m,
            parts: None,
            holes: None,
            handles: None,
        }
    }
}

impl PartOfWorkspace {
    fn of(part: SetPart) -> Self {
        Self { volume_m3: part.volume, handles: part.handles }
    }
}

impl InnerBox {
    fn of([lower, upper]: [Vec3; 2]) -> Self {
        Self { lower_m: lower.into(), upper_m: upper.into(), volume_m3: (upper - lower).product() }
    }
}

impl SectionOfWorkspace {
    fn of(surface: &BoundaryMesh, axis: usize, at_m: f64) -> Self {
        let section = surface.section(axis, at_m);
        let polygon = |points: &Vec<Vec3>| points.iter().map(|point| (*point).into()).collect();
        Self {
            axis: AXES[axis],
            at_m,
            area_m2: section.area,
            polygons_m: section.polygons.iter().map(polygon).collect(),
        }
    }
}

impl RaysOfWorkspace {
    pub(super) fn of(set: &RaySet, search: &RaysInBox) -> Self {
        let rays = set.rays();
        let hull = set.hull();
        let (count, step) = (rays.len(), search.step);
        let mut volumes = vec![VolumeRow::of_rays("rays", count, step, set.volume(), None)];
        if let Some(hull) = &hull {
            volumes.push(VolumeRow::of_rays("hull of rays", count, step, hull.volume(), Some(hull)));
        }
        Self {
            center_m: search.center.into(),
            count,
            with_several_intervals: rays.iter().filter(|ray| ray.intervals.len() > 1).count(),
            cut: rays.iter().filter(|ray| ray.is_cut()).count(),
            directions: set.sphere().directions().iter().map(|ray| (*ray).into()).collect(),
            intervals_m: rays.iter().map(|ray| ray.intervals.clone()).collect(),
            volumes,
            evaluations: set.evaluations(),
        }
    }
}

impl Tabled for Workspace {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        vec![("", VolumeRow::columns().described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(VolumeRow::columns(), &self.volumes)
    }
}

found!(Workspace, "workspace");
