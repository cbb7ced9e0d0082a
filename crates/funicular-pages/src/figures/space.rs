//! The robot in space: parallel projection, hanging cables, the platform between its attachments, a floor with scales.

mod moving;

pub use moving::animation_of_simulation;

use super::axis::{nice_step, round_numbers};
use super::bodies::BodySurface;
use super::drawing::{Align, BLACK, Colour, Drawing, Label, PaperPoint, Stroke, WHITE};
use super::drive::DriveLines;
use super::hull::faces;
use super::style::{AXIS_WIDTH, BLUE, CURVE_WIDTH, GREY, Type, VERMILION, around};
use super::supports::SupportAtRest;
use super::view::{EYE, extent, joined, ranges, sides};
use funicular::math::Vec3;
use funicular::robot::Robot;
use funicular::statics::Equilibrium;
use funicular_study::text::decimals;
use std::f64::consts::TAU;

/// Robot in space, at equilibrium and, for a mode shape, moved.
pub(crate) struct Space {
    pub(crate) title: String,
    rest: RobotShape,
    moved: Option<RobotShape>,
    /// Pulleys and drums at rest.
    drives: Vec<DriveLines>,
    /// Flexible supports at rest.
    supports: Vec<SupportAtRest>,
    /// Edges of obstacles, and of bodies of the platform at rest.
    edges: Vec<[Vec3; 2]>,
    /// Names of the cables at their anchors, and the sides on which they stand.
    names: Vec<(String, &'static str)>,
    /// Corners of each face of the platform.
    faces: Vec<Vec<usize>>,
    ranges: [(f64, f64); 3],
    /// Lines of text above the figure.
    head: Vec<String>,
}

/// Positions of cables and platform [m].
#[derive(Debug, Clone)]
pub(crate) struct RobotShape {
    /// Points along each cable from the platform to the anchor.
    pub(crate) cables: Vec<Vec<Vec3>>,
    /// Attachments.
    pub(crate) corners: Vec<Vec3>,
    pub(crate) mass_centre: Vec3,
}

/// Number of intervals of a drawn cable.
const INTERVALS: u32 = 64;

impl RobotShape {
    /// Robot at equilibrium.
    fn at_rest(robot: &Robot, equilibrium: &Equilibrium) -> Self {
        let fraction = |k: u32| f64::from(k) / f64::from(INTERVALS);
        let cables = equilibrium.cables.iter().map(|state| match &state.hanging {
            Some(hanging) => (0..=INTERVALS).map(|k| hanging.point_w(fraction(k) * state.free_length())).collect(),
            None => vec![state.attachment_w, state.anchor_w],
        });
        Self {
            cables: cables.collect(),
            corners: equilibrium.cables.iter().map(|state| state.attachment_w).collect(),
            mass_centre: equilibrium.pose.point_w(&robot.platform.center_of_mass_p),
        }
    }
}

impl Space {
    /// Drawing of a robot at equilibrium; `moved` is its shape in a mode.
    pub(crate) fn new(robot: &Robot, equilibrium: &Equilibrium, moved: Option<RobotShape>, head: Vec<String>) -> Self {
        let rest = RobotShape::at_rest(robot, equilibrium);
        let anchors: Vec<Vec3> = equilibrium.cables.iter().map(|state| state.anchor_w).collect();
        let names: Vec<String> = robot.cables.iter().map(|cable| cable.name.clone()).collect();
        let reach = extent(&anchors);
        let places = sides(&anchors, reach);
        let labels = joined(&anchors, &names, &places, reach);
        let drives = DriveLines::all(&robot.cables, &equilibrium.cables);
        let points = rest.cables.iter().flatten().chain(&rest.corners).chain(&anchors).copied();
        let mut bodies = BodySurface::obstacles(robot);
        bodies.extend(BodySurface::of_platform(robot, &equilibrium.pose));
        let points = points.chain(bodies.iter().flat_map(BodySurface::points));
        let points: Vec<Vec3> = points.chain(drives.iter().flat_map(DriveLines::points)).collect();
        Self {
            title: robot.name.clone(),
            faces: faces(&rest.corners),
            ranges: ranges(&points, true),
            names: labels.into_iter().zip(places).collect(),
            rest,
            moved,
            drives,
            supports: SupportAtRest::all(robot, equilibrium),
            edges: bodies.iter().flat_map(|body| body.edges(&Vec3::from(EYE))).collect(),
            head,
        }
    }

    /// Drawing with a width [pt] and a size of the texts.
    pub(crate) fn draw(&self, width: f64, style: &Type) -> Drawing {
        let size = style.size;
        let mut drawing = Drawing::new(&self.title, width);
        let view = View::new(&self.ranges, width, size, self.head.len());
        drawing.height = view.height;
        for (k, line) in self.head.iter().enumerate() {
            let label = Label::plain(line);
            let fitting = drawing.fitting(&label, size, width - size);
            drawing.text(label, [0.5 * size, (1.1 + 1.35 * k as f64) * size], Align::Start, fitting, BLACK);
        }
        self.draw_scales(&mut drawing, &view, style);
        let edges = self.edges.iter().map(|edge| edge.map(|point| view.at(point)).to_vec()).collect();
        drawing.lines(edges, Stroke::solid(GREY, AXIS_WIDTH));
        self.draw_drives(&mut drawing, &view, style);

        if let Some(moved) = &self.moved {
            let grey = Stroke { colour: GREY, width: 0.5, dashes: vec![2.5, 1.8] };
            let rest = self.rest.cables.iter().map(|line| line.iter().map(|p| view.at(*p)).collect());
            drawing.lines(rest.collect(), grey.clone());
            self.draw_platform(&mut drawing, &view, &self.rest, None, &grey, style);
            self.draw_shape(&mut drawing, &view, moved, style);
        } else {
            self.draw_shape(&mut drawing, &view, &self.rest, style);
        }
        self.draw_supports(&mut drawing, &view, style);
        self.draw_anchors(&mut drawing, &view, style);
        drawing
    }

    /// Cables and platform from back to front.
    fn draw_shape(&self, drawing: &mut Drawing, view: &View, shape: &RobotShape, style: &Type) {
        let centre = shape.corners.iter().sum::<Vec3>() / shape.corners.len() as f64;
        // A point mass is drawn last, on top of its cables' ends.
        let of_platform = if self.faces.is_empty() { f64::INFINITY } else { view.depth(centre) };
        let mut parts: Vec<(f64, Option<usize>)> = vec![(of_platform, None)];
        parts.extend(shape.cables.iter().enumerate().map(|(i, line)| (view.depth(line[line.len() / 2]), Some(i))));
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, part) in parts {
            if let Some(i) = part {
                let line = shape.cables[i].iter().map(|p| view.at(*p)).collect();
                drawing.line(line, Stroke::solid(BLUE, CURVE_WIDTH));
            } else {
                let edge = Stroke::solid(BLACK, AXIS_WIDTH);
                self.draw_platform(drawing, view, shape, Some(FACE), &edge, style);
            }
        }
    }

    fn draw_platform(
        &self,
        drawing: &mut Drawing,
        view: &View,
        shape: &RobotShape,
        fill: Option<Colour>,
        edge: &Stroke,
        style: &Type,
    ) {
        let depth =
            |face: &[usize]| face.iter().map(|&i| view.depth(shape.corners[i])).sum::<f64>() / face.len() as f64;

        let mut order: Vec<&Vec<usize>> = self.faces.iter().collect();
        order.sort_by(|a, b| depth(a).total_cmp(&depth(b)));

        for face in order {
            let corners: Vec<PaperPoint> = face.iter().map(|&i| view.at(shape.corners[i])).collect();
            drawing.areas(vec![corners], fill, Some(edge.clone()));
        }

        if fill.is_some() {
            let half = if self.faces.is_empty() { 0.4 * style.size } else { 0.16 * style.size };
            let [x, y] = view.at(shape.mass_centre);
            let diamond = vec![[x - half, y], [x, y - half], [x + half, y], [x, y + half]];
            drawing.areas(vec![diamond], Some(VERMILION), Some(Stroke::solid(BLACK, 0.3)));
        }
    }

    /// Wheels, and the cable from the exit points to the drums.
    fn draw_drives(&self, drawing: &mut Drawing, view: &View, style: &Type) {
        let flat = |line: &[Vec3]| line.iter().map(|p| view.at(*p)).collect::<Vec<PaperPoint>>();

        for drive in &self.drives {
            drawing.areas(vec![flat(&drive.wheel)], None, Some(Stroke::solid(GREY, AXIS_WIDTH)));
            drawing.line(flat(&drive.path), Stroke::solid(BLUE, 0.5 * CURVE_WIDTH));

            for (_, wheel) in &drive.guide_wheels {
                let [x, y] = view.at(*wheel);
                let corner = |k: u32| {
                    let angle = f64::from(k) / 24.0 * TAU;
                    [x + 0.22 * style.size * angle.cos(), y + 0.22 * style.size * angle.sin()]
                };
                let circle = (0..24).map(corner).collect();
                drawing.areas(vec![circle], Some(WHITE), Some(Stroke::solid(GREY, AXIS_WIDTH)));
            }

            if let Some(drum) = drive.drum {
                let half = 0.17 * style.size;
                let [x, y] = view.at(drum);
                let square =
                    vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
                drawing.areas(vec![square], Some(GREY), None);
            }
        }
    }

    /// Supports: a bar through the anchors, and beside it a spring on the ground with the support's name.
    fn draw_supports(&self, drawing: &mut Drawing, view: &View, style: &Type) {
        let size = style.size;
        let capital = drawing.font.capital_height() * style.small;
        let (bar, thin) = (Stroke::solid(BLACK, 2.0 * AXIS_WIDTH), Stroke::solid(BLACK, AXIS_WIDTH));
        for support in &self.supports {
            let mut points: Vec<PaperPoint> = support.anchors.iter().map(|p| view.at(*p)).collect();
            points.sort_by(|a, b| a[1].total_cmp(&b[1]));
            let Some([x, y]) = points.last().copied() else { continue };

            // The spring stands away from the middle of the figure, so that cables do not cross it.
            let outwards = if x < 0.5 * drawing.width { -1.0 } else { 1.0 };
            let (at, coil) = (x + 1.1 * size * outwards, 0.26 * size);
            points.push([at, y]);
            drawing.line(points, bar.clone());
            let mut spring = vec![[at, y], [at, y + 0.35 * size]];
            spring.extend((0..6).map(|k| {
                let side = if k % 2 == 0 { coil } else { -coil };
                [at + side, y + (0.35 + 0.22 * (f64::from(k) + 0.5)) * size]
            }));
            let ground = y + 2.0 * size;
            spring.extend([[at, ground - 0.33 * size], [at, ground]]);
            drawing.line(spring, thin.clone());

            // The ground.
            drawing.line(vec![[at - 0.6 * size, ground], [at + 0.6 * size, ground]], thin.clone());
            let hatch = |k: i32| {
                let left = at + (0.3 * f64::from(k) - 0.6) * size;
                vec![[left + 0.25 * size, ground], [left, ground + 0.25 * size]]
            };
            drawing.lines((0..4).map(hatch).collect(), Stroke::solid(GREY, 0.6 * AXIS_WIDTH));

            // The name begins beside the cable to the drum and stays on the page.
            let label = Label::plain(&support.name);
            let wide = drawing.width_of(&label, style.small);
            let left = if outwards > 0.0 { at - 0.6 * size } else { at + 0.6 * size - wide };
            let left = left.min(drawing.width - wide - 0.3 * size).max(0.3 * size);
            drawing.text(label, [left, ground + 0.5 * size + capital], Align::Start, style.small, GREY);
        }
    }

    fn draw_anchors(&self, drawing: &mut Drawing, view: &View, style: &Type) {
        let half = 0.17 * style.size;
        let capital = drawing.font.capital_height() * style.small;
        for (line, (name, side)) in self.rest.cables.iter().zip(&self.names) {
            let [x, y] = view.at(line[line.len() - 1]);
            let square = vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
            drawing.areas(vec![square], Some(BLACK), None);
            let (at, align) = match *side {
                "bottom center" => ([x, y + 2.5 * half + capital], Align::Middle),
                "middle left" => ([x - 2.5 * half, y + 0.5 * capital], Align::End),
                "middle right" => ([x + 2.5 * half, y + 0.5 * capital], Align::Start),
                _ => ([x, y - 2.5 * half], Align::Middle),
            };
            drawing.text(Label::plain(name), at, align, style.small, BLACK);
        }
    }

    /// Floor with its grid, scales along its front edges, heights along the left edge.
    fn draw_scales(&self, drawing: &mut Drawing, view: &View, style: &Type) {
        let size = style.size;
        let [(low_x, high_x), (low_y, high_y), (floor, _)] = self.ranges;
        let (low, high) = ([low_x, low_y], [high_x, high_y]);
        let capital = drawing.font.capital_height() * style.small;
        let corners = [[low_x, low_y], [high_x, low_y], [high_x, high_y], [low_x, high_y]];
        let on_floor = |p: [f64; 2]| view.at(Vec3::new(p[0], p[1], floor));
        drawing.areas(vec![corners.map(on_floor).to_vec()], Some(FLOOR), None);
        let middle = on_floor([0.5 * (low_x + high_x), 0.5 * (low_y + high_y)]);
        let front = [0, 1].map(|k| if view.towards[k] > 0.0 { high[k] } else { low[k] });
        let grid = Stroke::solid(GRID, 0.35);
        let axis = Stroke::solid(BLACK, AXIS_WIDTH);

        for k in [0, 1] {
            let other = 1 - k;
            let point = |value: f64, at: f64| {
                let mut p = [0.0, 0.0];
                (p[k], p[other]) = (value, at);
                on_floor(p)
            };
            let edge = [point(low[k], front[other]), point(high[k], front[other])];
            let (dx, dy) = (edge[1][0] - edge[0][0], edge[1][1] - edge[0][1]);
            let long = dx.hypot(dy).max(1e-9);
            // Direction at right angles to the edge, away from the floor.
            let side = if -dy * (edge[0][0] - middle[0]) + dx * (edge[0][1] - middle[1]) < 0.0 { -1.0 } else { 1.0 };
            let away = [-dy / long * side, dx / long * side];
            let (values, places) = scale(low[k], high[k], long, 3.0 * size);
            drawing.lines(
                values.iter().map(|value| vec![point(*value, low[other]), point(*value, high[other])]).collect(),
                grid.clone(),
            );
            let mut widest: f64 = 0.0;
            for value in values {
                let label = Label::plain(&decimals(value, places).replace('-', "−"));
                let width = drawing.width_of(&label, style.small);
                widest = widest.max(width);
                let [x, y] = point(value, front[other]);
                let off = 0.35 * size + 0.5 * (away[0].abs() * width + away[1].abs() * capital);
                let at = [x + off * away[0], y + off * away[1] + 0.5 * capital];
                drawing.text(label, at, Align::Middle, style.small, BLACK);
            }
            drawing.line(edge.to_vec(), axis.clone());
            let [x, y] = point(0.5 * (low[k] + high[k]), front[other]);
            let off = 1.35 * size + away[0].abs() * (widest + 0.4 * size) + away[1].abs() * 0.6 * size;
            let at = [x + off * away[0], y + off * away[1] + 0.5 * capital];
            drawing.text(Label::plain(["x [m]", "y [m]"][k]), at, Align::Middle, size, BLACK);
        }

        let left = corners.into_iter().min_by(|a, b| on_floor(*a)[0].total_cmp(&on_floor(*b)[0])).unwrap_or(corners[0]);
        self.draw_heights(drawing, view, left, style);
    }

    /// Heights along the edge above a corner of the floor.
    fn draw_heights(&self, drawing: &mut Drawing, view: &View, corner: [f64; 2], style: &Type) {
        let size = style.size;
        let (floor, top) = self.ranges[2];
        let capital = drawing.font.capital_height() * style.small;
        let axis = Stroke::solid(BLACK, AXIS_WIDTH);
        // A little to the left, so that its numbers keep away from the names of anchors above this corner.
        let at = |z: f64| {
            let [x, y] = view.at(Vec3::new(corner[0], corner[1], z));
            [x - size, y]
        };
        drawing.line(vec![at(floor), at(top)], axis.clone());
        let (values, places) = scale(floor, top, at(floor)[1] - at(top)[1], 2.0 * size);
        for value in values.into_iter().filter(|value| *value > floor + 0.02 * (top - floor)) {
            let [x, y] = at(value);
            drawing.line(vec![[x - style.tick, y], [x, y]], axis.clone());
            let label = Label::plain(&decimals(value, places).replace('-', "−"));
            let at = [x - style.tick - 0.3 * size, y + 0.5 * capital];
            drawing.text(label, at, Align::End, style.small, BLACK);
        }
        let [x, y] = at(top);
        drawing.text(Label::plain("z [m]"), [x, y - 0.6 * size], Align::Middle, size, BLACK);
    }
}

const FACE: Colour = [0xc4, 0xc8, 0xcc];
const FLOOR: Colour = [0xf3, 0xf4, 0xf5];
const GRID: Colour = [0xcc, 0xcc, 0xcc];

/// Round numbers of a scale with a length on the page and a minimum distance between them [pt], with their decimals.
fn scale(low: f64, high: f64, length: f64, apart: f64) -> (Vec<f64>, usize) {
    let step = nice_step((high - low) * (apart / length.max(apart)));
    let step = if step > 0.0 && step.is_finite() { step } else { 1.0 };
    let quarter = (step / 10_f64.powf(step.log10().floor()) - 2.5).abs() < 1e-6;
    let places = (-step.log10().floor() as i32 + i32::from(quarter)).max(0) as usize;
    (round_numbers(low, high, step), places)
}

/// Parallel projection onto the page.
struct View {
    right: Vec3,
    up: Vec3,
    towards: Vec3,
    scale: f64,
    /// Place of the origin of the world on the page.
    origin: PaperPoint,
    height: f64,
}

impl View {
    /// View of a box that fills the width [pt], below a number of lines of text.
    fn new(ranges: &[(f64, f64); 3], width: f64, size: f64, lines: usize) -> Self {
        let [x, y, z] = EYE;
        let towards = Vec3::new(x, y, z).normalize();
        let right = Vec3::z().cross(&towards).normalize();
        let up = towards.cross(&right);
        let corner = |mask: usize| {
            let part = |k: usize| if mask >> k & 1 == 1 { ranges[k].1 } else { ranges[k].0 };
            Vec3::new(part(0), part(1), part(2))
        };
        let flat = around((0..8).map(corner).map(|p| [right.dot(&p), -up.dot(&p)]));
        // Room for numbers and titles on all sides.
        let (side, above, below) = (3.2 * size, (1.9 + 1.35 * lines as f64) * size, 3.4 * size);
        let scale = (width - 2.0 * side) / flat.width();
        // A tall robot would fill more than a page.
        let scale = scale.min(1.4 * width / flat.height());
        let height = above + scale * flat.height() + below;
        let left = 0.5 * (width - scale * flat.width());
        let origin = [left - scale * flat.left, above - scale * flat.top];
        Self { right, up, towards, scale, origin, height }
    }

    fn at(&self, p: Vec3) -> PaperPoint {
        [self.origin[0] + self.scale * self.right.dot(&p), self.origin[1] - self.scale * self.up.dot(&p)]
    }

    /// Distance towards the eye [m].
    fn depth(&self, p: Vec3) -> f64 {
        self.towards.dot(&p)
    }
}
