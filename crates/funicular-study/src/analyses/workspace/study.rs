//! Search of a workspace, apart from the threads that evaluate its poses.

use super::conditions::Conditions;
use super::places::{self, PlaneOfMotion};
use super::rows::{ComparedSets, RaysOfWorkspace, WantedSet, Workspace, first_step};
use crate::analyses::prove::{ProofOfWorkspace, ProofStudy};
use crate::error::NoSolution;
use crate::names::{Named, OrientationRule};
use crate::request::{WorkspaceRequest, check_positive, check_vector};
use crate::sweep::{Options, options_of, with_request};
use anyhow::{Result, bail};
use funicular::level_set::{BoundaryMesh, Evaluate, LevelSet, PointGrid, RaySet, RaysInBox, SearchEnd, Sphere};
use funicular::math::{Rotation, Vec3};
use funicular::proof::PositionBox;
use funicular::robot::{Pose, Robot};
use funicular::warnings;
use std::collections::{HashMap, HashSet};

/// Set whose positions are evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SearchedSet {
    /// Set of the robot.
    Own,
    /// Set of the robot with which it is compared.
    Other,
    /// Positions of both.
    Common,
}

/// Values of many positions of a set, as [`Evaluate`].
pub type EvaluateSet<'a> = dyn FnMut(SearchedSet, &[Vec3]) -> Option<Vec<Option<f64>>> + 'a;

/// Robot with its conditions.
pub(super) struct JudgedRobot {
    pub(super) robot: Robot,
    options: Options,
    pub(super) conditions: Conditions,
}

/// Request of a workspace that is ready to run.
pub struct WorkspaceStudy {
    own: JudgedRobot,
    other: Option<JudgedRobot>,
    grid: PointGrid,
    plane: Option<PlaneOfMotion>,
    orientations: Vec<Rotation>,
    rule: OrientationRule,
    /// Tolerance of vertices and of ends of rays [m].
    tolerance: f64,
    rays: Option<(Sphere, Option<Vec3>)>,
    sections: Vec<(usize, f64)>,
    proof: Option<ProofStudy>,
}

impl WorkspaceStudy {
    /// Checks a request for a robot that has been read from its file.
    ///
    /// # Errors
    /// A request that contradicts itself or the robot.
    pub fn new(robot: Robot, request: &WorkspaceRequest) -> Result<Self> {
        places::check(request, &robot)?;
        request.vertex_tolerance_m.map_or(Ok(()), |given| check_positive("vertex_tolerance_m", given))?;
        check_vector("center_m", request.center_m)?;
        if request.center_m.is_some() && request.rays.is_none() {
            bail!("⟪center_m⟫ is the centre of rays: give ⟪rays⟫, too, or leave it out");
        }

        let own = JudgedRobot::new(robot, request)?;
        let other = request.compare.as_ref().map(|other| {
            let robot = other.read()?.robot;
            places::check(request, &robot)?;
            JudgedRobot::new(robot, request)
        });
        let other = other.transpose().map_err(|error| error.context("⟪compare⟫"))?;
        let (grid, plane) = places::grid(request, &own.robot)?;
        let orientations = places::orientations(request, &own.robot)?;
        let sections = places::sections(&request.section, &grid, plane)?;
        let rays = request.rays.map(places::sphere).transpose()?;
        let rays = rays.map(|sphere| (sphere, request.center_m.map(Vec3::from)));
        // A vertex that is interpolated to this is mostly a hundred times nearer, and the chords between vertices miss
        // a curved surface by more.
        let step = grid.step();
        let in_space = (0..3).filter(|k| plane.is_none_or(|plane| plane.axis != *k)).map(|k| step[k]);
        let tolerance = request.vertex_tolerance_m.unwrap_or(0.01 * in_space.fold(f64::INFINITY, f64::min));
        let rule = request.orientations;
        let proof = proof_of(request, &own, &grid, &orientations)?;
        Ok(Self { own, other, grid, plane, orientations, rule, tolerance, rays, sections, proof })
    }

    /// Proof that is wanted besides.
    pub fn proof(&self) -> Option<&ProofStudy> {
        self.proof.as_ref()
    }

    /// True if the result has sections.
    pub fn has_sections(&self) -> bool {
        !self.sections.is_empty()
    }

    /// Distance of a position from the limits of a set: not negative inside, negative outside, `None` outside and
    /// without a number. It is the least or the greatest one of all orientations, as the request wants all or some.
    pub fn value(&self, set: SearchedSet, position: &Vec3) -> Option<f64> {
        let of = |judged: &JudgedRobot| judged.value(position, &self.orientations, self.rule);
        match (set, &self.other) {
            (SearchedSet::Own, _) | (_, None) => of(&self.own),
            (SearchedSet::Other, Some(other)) => of(other),
            (SearchedSet::Common, Some(other)) => Some(of(&self.own)?.min(of(other)?)),
        }
    }

    /// Finds the set with the values that `evaluate` gives for [`Self::value`] of many positions; `None` if it stopped
    /// before a surface was found.
    ///
    /// # Errors
    /// No position of the grid meets the conditions, or a centre of rays outside the box.
    pub fn find(&self, evaluate: &mut EvaluateSet<'_>) -> Result<Option<Workspace>> {
        let mut by_plane = OncePerPlace { plane: self.plane, known: HashMap::new(), evaluate };
        let evaluate = &mut |set: SearchedSet, positions: &[Vec3]| by_plane.values(set, positions);
        let mut of_own = |positions: &[Vec3]| evaluate(SearchedSet::Own, positions);
        let Some(set) = LevelSet::find(self.grid.clone(), self.tolerance, &mut of_own) else { return Ok(None) };
        let surface = set.boundary(1);
        if surface.triangles().is_empty() {
            if set.end() != SearchEnd::Complete {
                return Ok(None);
            }
            let step = first_step(&self.grid, self.plane);
            let message = format!(
                "no position of the grid meets the conditions: it was searched with steps of {step} m; give a ⟪grid⟫ \
                 with smaller steps or another box, or other limits"
            );
            return Err(NoSolution(message).into());
        }
        let rays = self.along_rays(&surface, &mut of_own)?;
        let compared = self.compared(&surface, evaluate);
        let mut warnings: Vec<String> = warnings::of_robot(&self.own.robot).iter().map(ToString::to_string).collect();
        let wanted = WantedSet {
            robot: &self.own.robot.name,
            anchors: self.own.robot.cables.iter().map(|cable| cable.anchor.reference_w()).collect(),
            static_model: self.own.options.static_model.name(),
            conditions: &self.own.conditions.rows,
            orientations: (&self.orientations, self.rule.name()),
            tolerance: self.tolerance,
            sections: &self.sections,
            with_rays: self.rays.is_some(),
            with_other: self.other.is_some(),
            plane: self.plane,
        };
        let mut found = Workspace::of(&wanted, &set, &surface, rays, compared);
        warnings.append(&mut found.doubts());
        found.warnings = warnings;
        Ok(Some(found))
    }

    /// Set of the other robot, and what both sets share; absent without another robot, or if the work was stopped
    /// there.
    fn compared(&self, surface: &BoundaryMesh, evaluate: &mut EvaluateSet<'_>) -> Option<ComparedSets> {
        let other = self.other.as_ref()?;
        let mut volume = |which: SearchedSet| {
            let mut of_set = |positions: &[Vec3]| evaluate(which, positions);
            let set = LevelSet::find(self.grid.clone(), self.tolerance, &mut of_set)?;
            (set.end() == SearchEnd::Complete).then(|| (set.boundary(1).volume(), set.evaluations()))
        };
        let (of_other, common) = (volume(SearchedSet::Other)?, volume(SearchedSet::Common)?);
        let evaluations = of_other.1 + common.1;
        Some(ComparedSets::of(&other.robot.name, [surface.volume(), of_other.0, common.0], evaluations))
    }

    /// Intervals along the rays of the request; absent without rays, or if the work was stopped there.
    fn along_rays(&self, surface: &BoundaryMesh, evaluate: &mut Evaluate<'_>) -> Result<Option<RaysOfWorkspace>> {
        let Some((sphere, given)) = &self.rays else { return Ok(None) };
        let [lower, upper] = [self.grid.lower(), self.grid.upper()];
        let center = given.or_else(|| surface.centroid()).unwrap_or((lower + upper) * 0.5);
        if (0..3).any(|k| center[k] <= lower[k] || center[k] >= upper[k]) {
            let [x, y, z]: [f64; 3] = center.into();
            bail!("⟪center_m⟫: ({x}, {y}, {z}) m is not inside the box of the grid");
        }
        let step = self.grid.step().min();
        let search = RaysInBox { center, bounds: [lower, upper], step, tolerance: self.tolerance };
        let found = RaySet::find(sphere.clone(), &search, evaluate);
        Ok(found.map(|set| RaysOfWorkspace::of(&set, &search)))
    }
}

/// Proof about the box of the grid, if it is wanted.
fn proof_of(
    request: &WorkspaceRequest,
    own: &JudgedRobot,
    grid: &PointGrid,
    orientations: &[Rotation],
) -> Result<Option<ProofStudy>> {
    if !request.prove {
        if request.division.is_given() {
            bail!("⟪boxes⟫, ⟪undecided⟫ and ⟪time_s⟫ end a proof: give ⟪prove⟫, too, or leave them out");
        }
        return Ok(None);
    }
    if let Some(bound) = request.at_least.iter().chain(&request.at_most).next() {
        bail!(
            "⟪prove⟫ proves that tensions within their limits hold the required loads, and not the quantity `{}`, \
             which belongs to tensions that a rule chooses pose by pose: leave out ⟪at_least⟫ and ⟪at_most⟫, or \
             leave out ⟪prove⟫",
            bound.quantity
        );
    }
    let [rotation] = orientations else {
        bail!(
            "⟪prove⟫ divides positions at one orientation: leave out roll, pitch and yaw of ⟪grid⟫; `funicular prove` \
             with ⟪within_deg⟫ proves a box of positions with every turn up to a limit"
        );
    };
    let region = PositionBox { lower: grid.lower(), upper: grid.upper() };
    let (model, division) = (own.options.static_model, request.division);
    let of = ProofOfWorkspace { robot: &own.robot, model, rotation: *rotation, region, division };
    Ok(Some(ProofStudy::of_workspace(&of)?))
}

/// Values of positions; for a planar platform, positions of its slab that differ across the plane are evaluated once.
struct OncePerPlace<'a, 'b> {
    plane: Option<PlaneOfMotion>,
    known: HashMap<(SearchedSet, [u64; 3]), Option<f64>>,
    evaluate: &'a mut EvaluateSet<'b>,
}

impl OncePerPlace<'_, '_> {
    fn values(&mut self, set: SearchedSet, positions: &[Vec3]) -> Option<Vec<Option<f64>>> {
        let Some(plane) = self.plane else { return (self.evaluate)(set, positions) };
        let places: Vec<Vec3> = positions.iter().map(|position| plane.project(*position)).collect();
        let key = |place: &Vec3| (set, [place.x, place.y, place.z].map(f64::to_bits));

        let mut new: Vec<Vec3> = Vec::new();
        let mut wanted = HashSet::new();
        for place in &places {
            if !self.known.contains_key(&key(place)) && wanted.insert(key(place)) {
                new.push(*place);
            }
        }
        let values = (self.evaluate)(set, &new)?;
        self.known.extend(new.iter().map(key).zip(values));
        Some(places.iter().map(|place| self.known.get(&key(place)).copied().flatten()).collect())
    }
}

impl JudgedRobot {
    pub(super) fn new(robot: Robot, request: &WorkspaceRequest) -> Result<Self> {
        let mut point = request.point.clone();
        let robot = with_request(robot, &point)?;
        let options = options_of(&robot, &mut point)?;
        let conditions = Conditions::of(request, &robot, &options)?;
        Ok(Self { robot, options, conditions })
    }

    /// Distance of a pose from the limits, as [`Conditions::margin`].
    pub(super) fn margin(&self, pose: &Pose) -> Option<f64> {
        self.conditions.margin(&self.robot, pose, &self.options)
    }

    fn value(&self, position: &Vec3, orientations: &[Rotation], rule: OrientationRule) -> Option<f64> {
        let at = |rotation: &Rotation| self.margin(&Pose { position_w: *position, rot_wp: *rotation });
        match rule {
            OrientationRule::All => {
                let mut least = f64::INFINITY;
                for rotation in orientations {
                    least = least.min(at(rotation)?);
                }
                Some(least)
            }
            OrientationRule::Some => orientations.iter().filter_map(at).reduce(f64::max),
        }
    }
}
