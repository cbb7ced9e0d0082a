//! Trajectories of CASPR as tables of poses over time.
//!
//! # References
//!
//! The elements have the meaning that CASPR's own reader gives them (github.com/darwinlau/CASPR: JointTrajectory).

use super::bodies::{self, Joint};
use crate::import::draft::DraftMotion;
use crate::import::text;
use crate::import::xml::{Xml, children, content, tag};
use anyhow::{Result, bail};
use funicular::math::rotation;
use funicular_study::names::suggestion;
use funicular_study::text::clean;
use roxmltree::Node;
use std::fmt::Write as _;

/// Step between rows if a trajectory gives none [s].
const DEFAULT_STEP: f64 = 0.01;

/// Maximum number of rows of a table.
const MAX_ROWS: f64 = 1e6;

/// Table of a trajectory, with what had to be assumed.
pub(crate) struct TrajectoryTable {
    /// CSV with the columns of the paths that ⟪trajectory⟫ reads.
    pub(crate) csv: String,
    pub(crate) assumed: Vec<String>,
}

/// Names of all trajectories of a file, in its order.
pub(crate) fn names(xml: &Xml) -> Vec<String> {
    all(xml).filter_map(|node| node.attribute("id")).map(clean).collect()
}

/// Elements of trajectories: those of joints, or in old files all.
fn all<'n>(xml: &'n Xml<'_>) -> impl Iterator<Item = Node<'n, 'n>> {
    let joints = children(xml.root(), "joint_trajectories").next();
    joints.unwrap_or(xml.root()).children().filter(|node| node.is_element() && tag(*node).ends_with("trajectory"))
}

/// Table of the trajectory with this name.
///
/// # Errors
/// A name that no trajectory has; a kind of trajectory or joint that a table cannot hold; the line and value at fault.
pub(crate) fn table(xml: &Xml, bodies: &Xml, name: &str) -> Result<TrajectoryTable> {
    let Some(node) = all(xml).find(|node| node.attribute("id").is_some_and(|id| clean(id) == name)) else {
        bail!("⟪trajectory⟫: {} has no trajectory `{}`{}", xml.path(), clean(name), suggestion(name, &names(xml)));
    };

    let (joint, base) = bodies::joint_on_base(bodies)?;
    if joint.has_quaternion() {
        bail!(xml.error(
            node,
            "the coordinates of the joint are a quaternion, between whose values CASPR interpolates in a way of its \
             own; only trajectories of angles are read"
        ));
    }

    let mut assumed = Vec::new();
    let curve = Curve::read(xml, node, &joint, &mut assumed)?;
    let step = step(xml, node, &curve, &mut assumed)?;

    let has_angles = joint.motion != DraftMotion::PointMass;
    let mut csv = "t_s,x_m,y_m,z_m".to_owned();
    csv.push_str(if has_angles { ",roll_deg,pitch_deg,yaw_deg\n" } else { "\n" });
    for t in curve.times(step) {
        let (translation, rot_wp) = (joint.place)(&curve.at(t));
        let p = base + translation;
        let _ = write!(csv, "{t},{},{},{}", p.x, p.y, p.z);
        if has_angles {
            let [roll, pitch, yaw] = rotation::to_roll_pitch_yaw_deg(&rot_wp);
            let _ = write!(csv, ",{roll},{pitch},{yaw}");
        }
        csv.push('\n');
    }
    Ok(TrajectoryTable { csv, assumed })
}

/// Step between rows [s].
fn step(xml: &Xml, node: Node, curve: &Curve, assumed: &mut Vec<String>) -> Result<f64> {
    let child = xml.optional(node, "time_step")?.map(|node| xml.number(node)).transpose()?;
    let given = xml.optional_attribute_number(node, "time_step")?.or(child);
    let step = given.unwrap_or(DEFAULT_STEP);
    if given.is_none() {
        assumed.push(format!("the time step {DEFAULT_STEP} s: the trajectory gives none"));
    }
    if step <= 0.0 || curve.duration() / step > MAX_ROWS {
        bail!(xml.error(
            node,
            format!("a time step of {step} s is not possible for {} s: give a longer one", curve.duration())
        ));
    }
    Ok(step)
}

/// Coordinates of a joint over time: polynomials between points.
struct Curve {
    points: Vec<Point>,
    form: Form,
}

/// Coordinates at a time, with their derivatives where the form has them.
struct Point {
    t: f64,
    q: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

/// Form of a curve between points.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Linear,
    Cubic,
    /// Cubic whose velocities are the means of the slopes beside a point.
    CubicOfMeanVelocity,
    Quintic,
}

impl Form {
    /// Form of an element; `trajectory` is the quintic of old files.
    fn of(name: &str) -> Option<Self> {
        match name {
            "linear_spline_trajectory" => Some(Self::Linear),
            "cubic_spline_trajectory" => Some(Self::Cubic),
            "cubic_spline_average_velocity_trajectory" => Some(Self::CubicOfMeanVelocity),
            "quintic_spline_trajectory" | "trajectory" => Some(Self::Quintic),
            _ => None,
        }
    }
}

impl Curve {
    fn read(xml: &Xml, node: Node, joint: &Joint, assumed: &mut Vec<String>) -> Result<Self> {
        let Some(form) = Form::of(tag(node)) else {
            bail!(xml.error(
                node,
                format!(
                    "<{}> cannot be read; known are linear_spline_trajectory, cubic_spline_trajectory, \
                     cubic_spline_average_velocity_trajectory and quintic_spline_trajectory",
                    tag(node)
                )
            ));
        };
        if form == Form::Linear {
            assumed.push(
                "that the platform rounds the corners: a linear spline jumps in velocity at its points, and a path of \
                 the fifth degree passes its rows"
                    .to_owned(),
            );
        }

        let nodes = nodes_of_points(xml, node)?;
        let is_relative = node.attribute("time_definition").map(str::trim) == Some("relative");
        if nodes.len() > 2 && node.attribute("time_definition").is_none() {
            assumed.push("that times count from the start of the trajectory: it has no `time_definition`".to_owned());
        }

        let mut points: Vec<Point> = Vec::with_capacity(nodes.len());
        for (node, time) in nodes {
            let before = points.last().map(|point| point.t);
            let t = match (before, time) {
                (None, _) => 0.0,
                (Some(before), Some(time)) => time + if is_relative { before } else { 0.0 },
                (Some(_), None) => bail!(xml.error(node, "the point has no attribute `time`")),
            };
            if before.is_some_and(|before| t <= before) {
                bail!(xml.error(node, format!("its time {t} s is not after that of the point before it")));
            }
            points.push(Point::read(xml, node, joint, t, form)?);
        }
        if points.len() < 2 {
            bail!(xml.error(node, "a trajectory needs two points or more"));
        }
        let mut curve = Self { points, form };
        curve.set_mean_velocities();
        Ok(curve)
    }

    /// Velocities of the points between the first and the last one, as the means of the slopes beside them.
    fn set_mean_velocities(&mut self) {
        if self.form != Form::CubicOfMeanVelocity {
            return;
        }
        for i in 1..self.points.len() - 1 {
            let [before, here, after] = &self.points[i - 1..=i + 1] else { continue };
            let slope = |a: &Point, b: &Point, k: usize| (b.q[k] - a.q[k]) / (b.t - a.t);
            let mean = (0..here.q.len()).map(|k| 0.5 * (slope(before, here, k) + slope(here, after, k))).collect();
            self.points[i].velocity = mean;
        }
    }

    fn duration(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.t)
    }

    /// Times of the rows [s]: equal steps, and the end.
    fn times(&self, step: f64) -> impl Iterator<Item = f64> {
        let end = self.duration();
        // A last step that rounding has shortened to nothing is the end itself.
        let steps = (0..).map(move |i| f64::from(i) * step).take_while(move |t| *t < end - 1e-9 * end);
        steps.chain([end])
    }

    /// Coordinates at a time [s].
    fn at(&self, t: f64) -> Vec<f64> {
        let after = self.points.partition_point(|point| point.t <= t).clamp(1, self.points.len() - 1);
        let (a, b) = (&self.points[after - 1], &self.points[after]);
        let h = b.t - a.t;
        let s = ((t - a.t) / h).clamp(0.0, 1.0);
        let coordinate = |k: usize| {
            let (step, [va, vb]) =
                (b.q[k] - a.q[k], [&a.velocity, &b.velocity].map(|v| v.get(k).map_or(0.0, |v| v * h)));
            let [aa, ab] = [&a.acceleration, &b.acceleration].map(|of| of.get(k).map_or(0.0, |of| of * h * h));
            a.q[k]
                + match self.form {
                    Form::Linear => step * s,
                    Form::Cubic | Form::CubicOfMeanVelocity => {
                        s * (va + s * (3.0 * step - 2.0 * va - vb + s * (va + vb - 2.0 * step)))
                    }
                    Form::Quintic => {
                        let cubic = 10.0 * step - 6.0 * va - 4.0 * vb - 1.5 * aa + 0.5 * ab;
                        let quartic = -15.0 * step + 8.0 * va + 7.0 * vb + 1.5 * aa - ab;
                        let quintic = 6.0 * step - 3.0 * (va + vb) + 0.5 * (ab - aa);
                        s * (va + s * (0.5 * aa + s * (cubic + s * (quartic + s * quintic))))
                    }
                }
        };
        (0..a.q.len()).map(coordinate).collect()
    }
}

/// Nodes of the points of a trajectory with their times [s]. Old files have a begin, an end and a total time.
fn nodes_of_points<'n>(xml: &Xml, node: Node<'n, 'n>) -> Result<Vec<(Node<'n, 'n>, Option<f64>)>> {
    if let (Some(begin), Some(end)) = (children(node, "begin").next(), children(node, "end").next()) {
        let total = children(node, "time_total").next().map(|of| xml.number(of)).transpose()?;
        return Ok(vec![(begin, None), (end, total)]);
    }
    let Some(points) = children(node, "points").next() else {
        bail!(xml.error(node, format!("<{}> has no <points>", tag(node))));
    };
    children(points, "point").map(|point| Ok((point, xml.optional_attribute_number(point, "time")?))).collect()
}

impl Point {
    fn read(xml: &Xml, node: Node, joint: &Joint, t: f64, form: Form) -> Result<Self> {
        let list = |name: &str| -> Result<Option<Vec<f64>>> {
            let Some(of) = children(node, name).next() else { return Ok(None) };
            let numbers =
                text::numbers(&content(of)).map_err(|wrong| xml.error(of, format!("<{name}> holds {wrong}")))?;
            if numbers.len() != joint.count {
                let (given, wanted) = (numbers.len(), joint.count);
                bail!(xml.error(of, format!("<{name}> holds {given} numbers; the joint has {wanted} coordinates")));
            }
            Ok(Some(numbers))
        };
        let needed = |name: &str| -> Result<Vec<f64>> {
            list(name)?.ok_or_else(|| xml.error(node, format!("the point has no <{name}>")))
        };

        let q = needed("q")?;
        let velocity = match form {
            Form::Linear => Vec::new(),
            Form::Cubic | Form::Quintic => needed("q_dot")?,
            // Those of the points in between follow from the slopes.
            Form::CubicOfMeanVelocity => list("q_dot")?.unwrap_or_else(|| vec![0.0; joint.count]),
        };
        let acceleration = if form == Form::Quintic { needed("q_ddot")? } else { Vec::new() };
        Ok(Self { t, q, velocity, acceleration })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(form: Form, points: &[[f64; 4]]) -> Curve {
        let point = |[t, q, v, a]: &[f64; 4]| Point { t: *t, q: vec![*q], velocity: vec![*v], acceleration: vec![*a] };
        Curve { points: points.iter().map(point).collect(), form }
    }

    /// A polynomial of the form's degree passes its points with its derivatives: it is the polynomial itself.
    #[test]
    fn polynomials_of_the_degree_of_a_form_are_themselves() {
        let quintic = |t: f64| {
            [
                t,
                1.0 + t - 2.0 * t.powi(3) + 0.3 * t.powi(5),
                1.0 - 6.0 * t * t + 1.5 * t.powi(4),
                -12.0 * t + 6.0 * t.powi(3),
            ]
        };
        let cubic = |t: f64| [t, 2.0 - t + t * t - 0.5 * t.powi(3), -1.0 + 2.0 * t - 1.5 * t * t, 0.0];
        for t in [0.0, 0.31, 0.5, 1.1, 1.7] {
            let of = curve(Form::Quintic, &[quintic(0.0), quintic(0.5), quintic(1.7)]);
            assert!((of.at(t)[0] - quintic(t)[1]).abs() < 1e-13, "{t}");
            let of = curve(Form::Cubic, &[cubic(0.0), cubic(0.5), cubic(1.7)]);
            assert!((of.at(t)[0] - cubic(t)[1]).abs() < 1e-13, "{t}");
        }
        // A parabola has the mean of equally long slopes as its velocity.
        let parabola = |t: f64| [t, t * t, if (0.5..1.5).contains(&t) { 9.0 } else { 2.0 * t }, 0.0];
        let mut of = curve(Form::CubicOfMeanVelocity, &[parabola(0.0), parabola(1.0), parabola(2.0)]);
        of.set_mean_velocities();
        assert!((of.at(1.3)[0] - 1.69).abs() < 1e-14);
        let times: Vec<f64> = of.times(0.75).collect();
        assert_eq!(times, [0.0, 0.75, 1.5, 2.0]);
    }
}
