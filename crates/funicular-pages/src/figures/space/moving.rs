//! The simulated robot as an animated drawing: SVG with SMIL, which browsers play without a script, in true time and
//! again and again.

use super::{FACE, RobotShape, Space, View};
use crate::figures::drawing::{Align, BLACK, Colour, Drawing, DrawnPath, Label, Moving, PaperPoint, Stroke};
use crate::figures::style::{AXIS_WIDTH, BLUE, CURVE_WIDTH, GREY, Type, VERMILION};
use crate::figures::svg::svg;
use crate::figures::view::ranges;
use crate::figures::{DEFAULT_FONT_SIZE_PT, POINTS};
use funicular::math::Vec3;
use funicular_study::analyses::simulate::{Simulated, SimulatedFrame, SimulatedPicture};
use funicular_study::text::short;

/// Width of the drawing [mm]; browsers scale it.
const WIDTH_MM: f64 = 170.0;
/// Largest size of the moving parts [bytes], with which a file opens at once.
const MAX_BYTES: usize = 3_000_000;
/// Size of a moving point in a frame [bytes]: two numbers with two decimals.
const POINT_BYTES: usize = 13;
/// Points of a rope above which every second, third … is drawn.
const MAX_POINTS: usize = 32;
/// Colour of a slack cable.
const SLACK: Colour = VERMILION;

/// Text of an animated SVG file of a simulation: the robot in its frames, with a line of time and its events below.
/// Slack cables are red.
pub fn animation_of_simulation(found: &Simulated) -> String {
    let picture = &found.picture;
    let frames = thinned(picture);
    let space = Space::simulated(picture, &frames);
    let style = Type::new(DEFAULT_FONT_SIZE_PT);
    let (mut drawing, view) = space.backdrop(WIDTH_MM * POINTS, &style);
    let begin = frames[0].t_s;
    let duration = (frames[frames.len() - 1].t_s - begin).max(1e-3);
    let shares: Vec<f64> = frames.iter().map(|frame| (frame.t_s - begin) / duration).collect();
    let timed = |path: DrawnPath, each: Vec<Vec<PaperPoint>>| Moving {
        path,
        shares: shares.clone(),
        each,
        colours: Vec::new(),
        duration,
    };

    // Platform behind its cables, as in the order at the start for most views.
    let factor = picture.enlargement();
    let mut shapes: Vec<RobotShape> = frames.iter().map(|frame| shape(picture, frame)).collect();
    let start = shapes[0].clone();
    for shape in &mut shapes {
        enlarge(shape, &start, factor);
    }
    for face in space.faces_from_behind(&view, &shapes[0]) {
        let corners = |shape: &RobotShape| face.iter().map(|i| view.at(shape.corners[*i])).collect();
        let each: Vec<Vec<PaperPoint>> = shapes.iter().map(corners).collect();
        let stroke = Some(Stroke::solid(BLACK, AXIS_WIDTH));
        drawing.moving(timed(DrawnPath { lines: vec![each[0].clone()], closed: true, fill: Some(FACE), stroke }, each));
    }
    let spans = found.slack_spans();
    for i in 0..shapes[0].cables.len() {
        let each: Vec<Vec<PaperPoint>> =
            shapes.iter().map(|shape| shape.cables[i].iter().map(|p| view.at(*p)).collect()).collect();
        let stroke = Some(Stroke::solid(BLUE, CURVE_WIDTH));
        let path = DrawnPath { lines: vec![each[0].clone()], closed: false, fill: None, stroke };
        let mut colours = vec![(0.0, BLUE)];
        for span in spans.iter().filter(|span| span.cable == i) {
            colours.push(((span.from_s - begin) / duration, SLACK));
            colours.push(((span.until_s - begin) / duration, BLUE));
        }
        drawing.moving(Moving { colours, ..timed(path, each) });
    }
    let diamond = |shape: &RobotShape| {
        let ([x, y], half) = (view.at(shape.mass_centre), 0.16 * style.size);
        vec![[x - half, y], [x, y - half], [x + half, y], [x, y + half]]
    };
    let each: Vec<Vec<PaperPoint>> = shapes.iter().map(diamond).collect();
    let stroke = Some(Stroke::solid(BLACK, 0.3));
    let path = DrawnPath { lines: vec![each[0].clone()], closed: true, fill: Some(VERMILION), stroke };
    drawing.moving(timed(path, each));
    if factor > 1.0 {
        let text = format!("displacements {} times as large", short(factor, 3));
        let at = [drawing.width - style.size, 1.2 * style.size];
        drawing.text(Label::plain(&text), at, Align::End, style.small, BLACK);
    }
    draw_time(&mut drawing, found, (begin, duration), &style);
    svg(&drawing)
}

/// Frames that fit the size of the file, with as many points as their ropes are drawn with.
fn thinned(picture: &SimulatedPicture) -> Vec<SimulatedFrame> {
    let points = |curve: &Vec<Vec3>| curve.len().min(MAX_POINTS + 1);
    let first = &picture.frames[0];
    let of_ropes: usize = first.curves.iter().map(points).sum();
    let of_faces = 6 * first.curves.len();
    let most = (MAX_BYTES / (POINT_BYTES * (of_ropes + of_faces).max(1))).max(2);
    let last = picture.frames.len() - 1;
    let parts = last.min(most - 1).max(1);
    let mut kept: Vec<usize> = (0..=parts).map(|k| k * last / parts).collect();
    kept.dedup();
    kept.into_iter().map(|k| picture.frames[k].clone()).collect()
}

/// Robot of a frame as it is drawn. A rope that is gone lies in its anchor.
fn shape(picture: &SimulatedPicture, frame: &SimulatedFrame) -> RobotShape {
    let robot = &picture.robot;
    let curve = |(i, now): (usize, &Vec<Vec3>)| {
        let at_start = &picture.frames[0].curves[i];
        let step = (at_start.len().saturating_sub(1)).div_ceil(MAX_POINTS).max(1);
        let last = at_start.len() - 1;
        let anchor = at_start[last];
        let points = (0..last).step_by(step).chain([last]);
        points.map(|k| now.get(k).copied().unwrap_or(anchor)).collect()
    };
    // A half at the platform lies in its attachment until its cable fails.
    let half = |(i, now): &(usize, Vec<Vec3>)| {
        let last = picture.frames[0].curves[*i].len() - 1;
        let step = last.div_ceil(MAX_POINTS).max(1);
        let attachment = frame.pose.point_w(&robot.cables[*i].attachment_p);
        let points = (0..last).step_by(step).chain([last]);
        points.map(|k| now.get(k).copied().unwrap_or(attachment)).collect()
    };
    RobotShape {
        cables: frame.curves.iter().enumerate().map(curve).chain(frame.halves.iter().map(half)).collect(),
        corners: robot.cables.iter().map(|cable| frame.pose.point_w(&cable.attachment_p)).collect(),
        mass_centre: frame.pose.point_w(&robot.platform.center_of_mass_p),
    }
}

/// Draws displacements since the start larger by a factor.
fn enlarge(shape: &mut RobotShape, start: &RobotShape, factor: f64) {
    let away = |p: &mut Vec3, q: &Vec3| *p = q + (*p - q) * factor;
    let cables = shape.cables.iter_mut().zip(&start.cables);
    cables.for_each(|(line, from)| line.iter_mut().zip(from).for_each(|(p, q)| away(p, q)));
    shape.corners.iter_mut().zip(&start.corners).for_each(|(p, q)| away(p, q));
    away(&mut shape.mass_centre, &start.mass_centre);
}

/// Line of time below the robot, with its events and a mark that moves along.
fn draw_time(drawing: &mut Drawing, found: &Simulated, (begin, duration): (f64, f64), style: &Type) {
    let size = style.size;
    let (left, right) = (3.0 * size, drawing.width - 3.0 * size);
    let y = drawing.height + 0.9 * size;
    let x = |time: f64| left + (right - left) * ((time - begin) / duration).clamp(0.0, 1.0);
    let axis = Stroke::solid(BLACK, AXIS_WIDTH);
    for mark in &found.picture.marks {
        if let Some(until) = mark.until_s {
            drawing.line(vec![[x(mark.from_s), y], [x(until), y]], Stroke::solid(GREY, 3.0));
        }
    }
    drawing.line(vec![[left, y], [right, y]], axis.clone());
    let base = y + 1.6 * size;
    let mut taken = left;
    for mark in &found.picture.marks {
        let at = x(mark.from_s);
        drawing.line(vec![[at, y - 0.4 * size], [at, y + 0.4 * size]], axis.clone());
        let label = Label::plain(&mark.what);
        let width = drawing.width_of(&label, style.small);
        // A name that would cover the one before is left out.
        if at >= taken && at + width < right - 3.0 * size {
            drawing.text(label, [at, base], Align::Start, style.small, BLACK);
            taken = at + width + 0.6 * size;
        }
    }
    let end = format!("{} s", short(begin + duration, 4));
    drawing.text(Label::plain(&end), [right, base], Align::End, style.small, BLACK);
    let half = 0.35 * size;
    let mark = |at: f64| vec![[at - half, y - 2.0 * half], [at + half, y - 2.0 * half], [at, y]];
    let path = DrawnPath { lines: vec![mark(left)], closed: true, fill: Some(BLACK), stroke: None };
    let (each, shares) = (vec![mark(left), mark(right)], vec![0.0, 1.0]);
    drawing.moving(Moving { path, shares, each, colours: Vec::new(), duration });
    drawing.height = base + 0.8 * size;
}

impl Space {
    /// Robot of a simulation, in a room that holds all frames.
    fn simulated(picture: &SimulatedPicture, frames: &[SimulatedFrame]) -> Self {
        let space = Self::new(&picture.robot, &picture.rest, None, Vec::new());
        let moved = frames.iter().flat_map(|frame| {
            let corners = picture.robot.cables.iter().map(|cable| frame.pose.point_w(&cable.attachment_p));
            let halves = frame.halves.iter().flat_map(|(_, curve)| curve);
            frame.curves.iter().flatten().chain(halves).copied().chain(corners)
        });
        let corner = |of: fn(&(f64, f64)) -> f64| Vec3::from(space.ranges.each_ref().map(of));
        // The ranges at rest have their margin already; the motion needs room only where it leaves them.
        let inside = |p: &Vec3| (0..3).all(|k| (space.ranges[k].0..=space.ranges[k].1).contains(&p[k]));
        let outside: Vec<Vec3> = moved.filter(|p| !inside(p)).collect();
        if outside.is_empty() {
            return space;
        }
        let all: Vec<Vec3> = outside.into_iter().chain([corner(|range| range.0), corner(|range| range.1)]).collect();
        Self { ranges: ranges(&all, true), ..space }
    }

    /// Everything that does not move, and its projection.
    fn backdrop(&self, width: f64, style: &Type) -> (Drawing, View) {
        let mut drawing = Drawing::new(&self.title, width);
        let view = View::new(&self.ranges, width, style.size, 0);
        drawing.height = view.height;
        self.draw_scales(&mut drawing, &view, style);
        let edges = self.edges.iter().map(|edge| edge.map(|point| view.at(point)).to_vec()).collect();
        drawing.lines(edges, Stroke::solid(GREY, AXIS_WIDTH));
        self.draw_drives(&mut drawing, &view, style);
        self.draw_supports(&mut drawing, &view, style);
        self.draw_anchors(&mut drawing, &view, style);
        (drawing, view)
    }

    /// Corners of the platform's faces, the farthest first.
    fn faces_from_behind(&self, view: &View, shape: &RobotShape) -> Vec<Vec<usize>> {
        let depth =
            |face: &Vec<usize>| face.iter().map(|i| view.depth(shape.corners[*i])).sum::<f64>() / face.len() as f64;
        let mut order = self.faces.clone();
        order.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        order
    }
}
