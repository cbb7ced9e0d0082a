//! Figures of the robot in space, to scale and with hanging cables.

use super::{CABLE_COLOURS, PageFigure, colour, plain, rounded};
use crate::figures::bodies::{BodySurface, is_hidden};
use crate::figures::drive::DriveLines;
use crate::figures::hull::faces;
use crate::figures::supports::SupportAtRest;
use crate::figures::view::{EYE, extent, joined, polygon, ranges, sides};
use funicular::math::Vec3;
use funicular::robot::{Pose, Robot};
use funicular::statics::{CableState, Equilibrium};
use funicular_study::analyses::prove::Proved;
use funicular_study::analyses::simulate::{SimulatedFrame, SimulatedPicture};
use funicular_study::analyses::workspace::Workspace;
use serde_json::{Value, json};

/// Number of points drawn along a cable; its curve is smooth, and a straight cable needs only two.
const SAMPLES: u32 = 48;
/// Figure of the complete robot.
pub(crate) fn complete(robot: &Robot, equilibrium: &Equilibrium) -> PageFigure {
    let drawn = Drawn::of(robot, equilibrium);
    let caption = format!(
        "The robot at its equilibrium, with one scale for all three axes. Lines: cables; squares: anchors with the \
         cables' names; dark body: the platform, spanned by the attachments.{} Drag to rotate, scroll to zoom, point \
         at a cable for its length and tension.",
        drawn.further
    );
    in_space(caption, &drawn.traces, &drawn.points)
}

/// Figure of a robot in motion at the first of several equilibria; and the coordinates of all traces that move, one
/// list per equilibrium, with the indices of these traces.
pub(crate) fn moving(robot: &Robot, equilibria: &[&Equilibrium]) -> (PageFigure, Value) {
    let drawn: Vec<Drawn> = equilibria.iter().map(|equilibrium| Drawn::of(robot, equilibrium)).collect();
    over_time("The robot on its path", &drawn)
}

/// Figure of a simulated robot at the first of its pictures; and the coordinates of all traces that move, as for a
/// [`moving`] robot.
pub(crate) fn simulated(of: &SimulatedPicture) -> (PageFigure, Value) {
    let drawn: Vec<Drawn> = of.frames.iter().map(|frame| Drawn::simulated(of, frame)).collect();
    over_time("The simulated robot", &drawn)
}

/// Figure of the first of several drawn robots, and the coordinates of the traces that move.
fn over_time(what: &str, drawn: &[Drawn]) -> (PageFigure, Value) {
    let first = &drawn[0];
    let points: Vec<Vec3> = drawn.iter().flat_map(|drawn| drawn.points.iter().copied()).collect();
    let caption = format!(
        "{what}, with one scale for all three axes. Lines: cables; squares: anchors with the cables' names; dark body: \
         the platform, spanned by the attachments.{} Move the time below, or play it; drag to rotate, scroll to zoom.",
        first.further
    );

    let place = |drawn: &Drawn, k: usize| ["x", "y", "z"].map(|axis| drawn.traces[k][axis].clone());
    let moves = |k: &usize| drawn.iter().any(|other| place(other, *k) != place(first, *k));
    let traces: Vec<usize> = (0..first.traces.len()).filter(moves).collect();
    let frames: Vec<Vec<[Value; 3]>> =
        drawn.iter().map(|drawn| traces.iter().map(|k| place(drawn, *k)).collect()).collect();
    (in_space(caption, &first.traces, &points), json!({"traces": traces, "frames": frames}))
}

/// Figure of traces in a scene around points.
fn in_space(caption: String, traces: &[Value], points: &[Vec3]) -> PageFigure {
    PageFigure::new(
        "figure-robot",
        400,
        caption,
        traces,
        json!({
            "scene": scene(points, true, WIDE), "showlegend": false, "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        }),
    )
}

/// Complete robot as it is drawn.
struct Drawn {
    traces: Vec<Value>,
    points: Vec<Vec3>,
    /// Sentences about what only some robots have.
    further: String,
}

impl Drawn {
    fn of(robot: &Robot, equilibrium: &Equilibrium) -> Self {
        let cables = (0..robot.cables.len()).map(|i| cable(robot, equilibrium, i)).collect();
        Self::with_cables(robot, equilibrium, &equilibrium.pose, cables)
    }

    /// Robot in a picture of a simulation. What lies behind the anchors stands as at the start.
    fn simulated(of: &SimulatedPicture, frame: &SimulatedFrame) -> Self {
        let hover = |i: usize| format!("cable {}<extra></extra>", plain(&of.robot.cables[i].name));
        let cables = frame.curves.iter().enumerate().chain(frame.halves.iter().map(|(i, curve)| (*i, curve)));
        let lines = cables.clone().map(|(i, curve)| cable_line(i, curve, &hover(i))).collect();
        let mut drawn = Self::with_cables(&of.robot, &of.rest, &frame.pose, lines);
        drawn.points.extend(cables.flat_map(|(_, curve)| curve).filter(|point| !is_hidden(&of.robot, point)));
        drawn
    }

    /// Robot with its platform at a pose and traces of its cables.
    fn with_cables(robot: &Robot, equilibrium: &Equilibrium, pose: &Pose, mut traces: Vec<Value>) -> Self {
        let anchors: Vec<Vec3> = equilibrium.cables.iter().map(|c| c.anchor_w).collect();
        traces.push(named_anchors(robot, &anchors));
        traces.extend(platform(robot, pose, false));

        let mut points = anchors;
        for state in &equilibrium.cables {
            points.extend(curve(state, state.free_length()));
        }
        let mut driven = "";
        for (i, (cable, state)) in robot.cables.iter().zip(&equilibrium.cables).enumerate() {
            let Some(lines) = DriveLines::of(cable, state) else { continue };
            driven = " At pulleys the squares are the exit points. The drums, grey squares, stand where they would be \
                      if the cable came to its pulley in a straight line.";
            traces.extend(drive(i, &cable.name, &lines));
            points.extend(lines.points());
        }

        let supports = SupportAtRest::all(robot, equilibrium);
        let supported =
            if supports.is_empty() { "" } else { " Crosses with a bar to their anchors: flexible supports." };
        traces.extend(supports.iter().flat_map(support));

        let mut bodies = BodySurface::obstacles(robot);
        let obstacles = if bodies.is_empty() { "" } else { " Grey bodies: obstacles." };
        bodies.extend(BodySurface::of_platform(robot, pose));
        points.extend(bodies.iter().flat_map(BodySurface::points));
        traces.extend(bodies.iter().filter(|body| !body.triangles.is_empty()).map(surface));
        Self { traces, points, further: format!("{driven}{supported}{obstacles}") }
    }
}

/// Figure of the surface of a workspace with the anchors.
pub(crate) fn surface_in_space(found: &Workspace, caption: String) -> PageFigure {
    let vertices: Vec<Vec3> = found.vertices_m.iter().map(|vertex| Vec3::from(*vertex)).collect();
    let (of_set, of_box) = found.triangles.split_at(found.triangles_of_surface);
    let mut data = vec![triangles(&vertices, of_set, colour::SKY, 0.85)];
    if !of_box.is_empty() {
        data.push(triangles(&vertices, of_box, "#999999", 0.6));
    }
    data.extend(found.anchors.iter().map(|anchor| marker(*anchor, "square", 4, "anchor<extra></extra>")));

    let mut points = vertices;
    points.extend(&found.anchors);
    PageFigure::new(
        "figure-surface",
        520,
        caption,
        &data,
        json!({
            "scene": scene(&points, true, WIDE), "showlegend": false, "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        }),
    )
}

/// Figure of the surface of what is proved inside, with the anchors.
pub(crate) fn proved_in_space(found: &Proved) -> PageFigure {
    let anchors: Vec<Vec3> = found.statement.cables().map(|cable| cable.anchor_w).collect();
    let mut data = vec![triangles(&found.surface.vertices, &found.surface.triangles, colour::BLUE, 0.85)];
    data.extend(anchors.iter().map(|anchor| marker(*anchor, "square", 4, "anchor<extra></extra>")));
    let mut points = found.surface.vertices.clone();
    points.extend(&anchors);
    PageFigure::new(
        "figure-proved",
        520,
        "Set that is proved inside, with one scale for all three axes. Squares: anchors. Drag to rotate, scroll to \
         zoom.",
        &data,
        json!({
            "scene": scene(&points, true, WIDE), "showlegend": false, "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        }),
    )
}

/// Trace of triangles by the numbers of their vertices.
fn triangles(vertices: &[Vec3], triangles: &[[usize; 3]], colour: &str, opacity: f64) -> Value {
    let [x, y, z] = coordinates(vertices);
    let corner = |k: usize| triangles.iter().map(|triangle| triangle[k]).collect::<Vec<usize>>();
    json!({
        "type": "mesh3d", "x": x, "y": y, "z": z, "i": corner(0), "j": corner(1), "k": corner(2), "color": colour,
        "opacity": opacity, "flatshading": false, "hovertemplate": "(%{x:.4g}, %{y:.4g}, %{z:.4g}) m<extra></extra>",
        // For the script that saves the figure as lines.
        "meta": {"faces": triangles},
    })
}

/// Trace of the free span of cable `i`.
fn cable(robot: &Robot, equilibrium: &Equilibrium, i: usize) -> Value {
    let state = &equilibrium.cables[i];
    let hover = format!(
        "cable {}<br>{:.4} m unstrained<br>{:.2} N at the platform<extra></extra>",
        plain(&robot.cables[i].name),
        state.unstrained_length,
        state.tension_platform
    );
    cable_line(i, &curve(state, state.free_length()), &hover)
}

/// Trace of the anchors with the names of their cables.
fn named_anchors(robot: &Robot, anchors: &[Vec3]) -> Value {
    let names: Vec<String> = robot.cables.iter().map(|c| plain(&c.name)).collect();
    let reach = extent(anchors);
    let places = sides(anchors, reach);
    let mut trace = labelled(anchors, &names, &places, colour::BLACK, "square", "anchor");
    trace["text"] = json!(joined(anchors, &names, &places, reach));
    trace
}

/// Traces of the drive of cable `i`: the cable beyond its exit point, the pulley, the drum and the guide wheels.
fn drive(i: usize, cable: &str, lines: &DriveLines) -> Vec<Value> {
    let cable = plain(cable);
    let mut traces = vec![cable_line(i, &lines.path, &format!("cable {cable}<extra></extra>")), wheel(&lines.wheel)];
    traces.extend(lines.drum.map(|drum| marker(drum, "square", 4, &format!("drum of cable {cable}<extra></extra>"))));
    traces.extend(lines.guide_wheels.iter().map(|(name, wheel)| {
        let hover = format!("guide wheel {} of cable {cable}<extra></extra>", plain(name));
        marker(*wheel, "circle-open", 6, &hover)
    }));
    traces
}

/// Grey marker at a place.
fn marker(at: Vec3, symbol: &str, size: u32, hover: &str) -> Value {
    json!({
        "type": "scatter3d", "mode": "markers", "x": rounded(&[at.x]), "y": rounded(&[at.y]), "z": rounded(&[at.z]),
        "marker": {"color": "#777777", "symbol": symbol, "size": size}, "hovertemplate": hover,
    })
}

/// Traces of a support: a bar from its middle to its anchors, and a cross with its name in the middle.
fn support(support: &SupportAtRest) -> [Value; 2] {
    let middle = support.middle();
    let bar: Vec<Vec3> = support.anchors.iter().flat_map(|anchor| [middle, *anchor]).collect();
    let [x, y, z] = coordinates(&bar);
    let bar = json!({
        "type": "scatter3d", "mode": "lines", "x": x, "y": y, "z": z, "line": {"color": "#777777", "width": 7},
        "hoverinfo": "skip",
    });
    let moved = support.displacement * 1e3;
    let hover = format!(
        "support {}, displaced by<br>({:.3}, {:.3}, {:.3}) mm<extra></extra>",
        plain(&support.name),
        moved.x,
        moved.y,
        moved.z
    );
    let mut cross = marker(middle, "cross", 5, &hover);
    cross["mode"] = json!("markers+text");
    cross["text"] = json!([plain(&support.name)]);
    cross["textposition"] = json!("bottom center");
    cross["textfont"] = json!({"size": 11, "color": "#777777"});
    [bar, cross]
}

/// Rim of a wheel.
fn wheel(rim: &[Vec3]) -> Value {
    let [x, y, z] = coordinates(rim);
    json!({
        "type": "scatter3d", "mode": "lines", "x": x, "y": y, "z": z, "line": {"color": "#777777", "width": 3},
        "hoverinfo": "skip",
    })
}

/// Figure of the platform and the first part of its cables.
pub(crate) fn close_up(robot: &Robot, equilibrium: &Equilibrium) -> PageFigure {
    let attachments: Vec<Vec3> = equilibrium.cables.iter().map(|c| c.attachment_w).collect();
    let reach = extent(&attachments).max(0.2);
    let mut points = attachments.clone();
    let mut data = Vec::new();

    for (i, state) in equilibrium.cables.iter().enumerate() {
        let hover = format!("cable {}<extra></extra>", plain(&robot.cables[i].name));
        let part = (0.6 * reach / state.chord()).min(1.0);
        let stub = curve(state, part * state.free_length());
        data.push(cable_line(i, &stub, &hover));
        points.extend(stub);
    }

    data.extend(platform(robot, &equilibrium.pose, true));
    let origin = equilibrium.pose.position_w;
    for (k, (name, colour)) in
        [("x", colour::VERMILION), ("y", colour::GREEN), ("z", colour::BLUE)].into_iter().enumerate()
    {
        let mut unit = Vec3::zeros();
        unit[k] = 0.22 * reach;
        let tip = origin + equilibrium.pose.rot_wp * unit;
        points.push(tip);
        data.push(json!({
            "type": "scatter3d", "mode": "lines+text", "x": rounded(&[origin.x, tip.x]),
            "y": rounded(&[origin.y, tip.y]),
            "z": rounded(&[origin.z, tip.z]), "line": {"color": colour, "width": 5}, "text": ["", name],
            "textfont": {"color": colour, "size": 13}, "hoverinfo": "skip",
        }));
    }

    PageFigure::new(
        "figure-platform",
        400,
        "The platform: attachments with the cables' names, axes of the platform frame, centre of mass (diamond), and \
         the first part of each cable.",
        &data,
        json!({
            "scene": scene(&points, false, SQUARE), "showlegend": false, "margin": {"l": 0, "r": 0, "t": 0, "b": 0},
        }),
    )
}

/// Ratio of width to height of a view: the wide view, and the view on a third of the page.
const WIDE: f64 = 1.85;
const SQUARE: f64 = 1.2;
/// Height of the drawn volume in plotly's units. It fills a view with parallel projection and leaves room for labels.
const FILL: f64 = 1.35;

/// Scene with equal scales around points, as large as fits a view with this ratio of width to height. With `floor` the
/// scene reaches down to z = 0 if the points are above it.
fn scene(points: &[Vec3], floor: bool, width: f64) -> Value {
    let ranges = ranges(points, floor);
    let span = ranges.map(|(low, high)| high - low);

    let [x, y, z] = EYE;
    let (level, far) = (x.hypot(y), x.hypot(y).hypot(z));
    let across = (span[0] * y.abs() + span[1] * x.abs()) / level;
    let upright = (span[2] * level + (span[0] * x.abs() + span[1] * y.abs()) / level * z) / far;
    let scale = FILL * (width / across).min(1.0 / upright);

    let axis = |k: usize, title: &str| {
        json!({
            "title": {"text": title, "font": {"size": 12}}, "tickfont": {"size": 10}, "nticks": 6,
            "showbackground": k == 2,
            "range": rounded(&[ranges[k].0, ranges[k].1]), "backgroundcolor": "#f3f4f5", "gridcolor": "#d9d9d9",
            "zeroline": false, "showspikes": false,
        })
    };

    let ratio = rounded(&span.map(|s| s * scale));
    json!({
        "aspectmode": "manual", "aspectratio": {"x": ratio[0], "y": ratio[1], "z": ratio[2]},
        "camera": {
            "eye": {"x": x, "y": y, "z": z}, "center": {"x": 0.0, "y": 0.0, "z": -0.06},
            "projection": {"type": "orthographic"},
        },
        "xaxis": axis(0, "x [m]"), "yaxis": axis(1, "y [m]"), "zaxis": axis(2, "z [m]"),
    })
}

/// Points of a cable from the attachment up to an unstrained arc length.
fn curve(state: &CableState, up_to: f64) -> Vec<Vec3> {
    if let Some(hanging) = &state.hanging {
        return (0..=SAMPLES).map(|k| hanging.point_w(up_to * f64::from(k) / f64::from(SAMPLES))).collect();
    }
    let part = up_to / state.free_length();
    vec![state.attachment_w, state.attachment_w + (state.anchor_w - state.attachment_w) * part]
}

fn coordinates(points: &[Vec3]) -> [Vec<Option<f64>>; 3] {
    [0, 1, 2].map(|k| rounded(&points.iter().map(|p| p[k]).collect::<Vec<_>>()))
}

fn cable_line(i: usize, points: &[Vec3], hover: &str) -> Value {
    let [x, y, z] = coordinates(points);
    json!({
        "type": "scatter3d", "mode": "lines", "x": x, "y": y, "z": z, "hovertemplate": hover,
        "line": {"color": CABLE_COLOURS[i % CABLE_COLOURS.len()], "width": 4},
    })
}

fn labelled(points: &[Vec3], names: &[String], sides: &[&str], colour: &str, symbol: &str, what: &str) -> Value {
    let [x, y, z] = coordinates(points);
    let hover: Vec<String> = names.iter().map(|name| format!("{what} of cable {name}")).collect();
    json!({
        "type": "scatter3d", "mode": "markers+text", "x": x, "y": y, "z": z, "text": names, "textposition": sides,
        "textfont": {"size": 12}, "marker": {"color": colour, "symbol": symbol, "size": 4}, "hovertext": hover,
        "hovertemplate": "%{hovertext}<br>(%{x:.4f}, %{y:.4f}, %{z:.4f}) m<extra></extra>",
    })
}

/// Traces of the platform: body between the attachments and centre of mass; `names` adds the names of the attachments.
fn platform(robot: &Robot, pose: &Pose, names: bool) -> Vec<Value> {
    let attachments: Vec<Vec3> = robot.cables.iter().map(|cable| pose.point_w(&cable.attachment_p)).collect();
    let com = pose.point_w(&robot.platform.center_of_mass_p);
    let reach = extent(&attachments);

    let mut data = Vec::new();
    if reach > 0.0 {
        data.push(body(&attachments, reach));
        if names {
            let labels: Vec<String> = robot.cables.iter().map(|c| plain(&c.name)).collect();
            let places = sides(&attachments, reach);
            data.push(labelled(&attachments, &labels, &places, "#333333", "circle", "attachment"));
        }
    }

    let hover = format!(
        "centre of mass, {:.2} kg<br>(%{{x:.4f}}, %{{y:.4f}}, %{{z:.4f}}) m<extra></extra>",
        robot.platform.mass
    );
    data.push(json!({
        "type": "scatter3d", "mode": "markers", "x": [com.x], "y": [com.y], "z": [com.z],
        "marker": {"color": colour::BLACK, "symbol": "diamond", "size": if names { 5 } else { 3 }},
        "hovertemplate": hover,
    }));
    data
}

/// Surface of an obstacle or of a body of the platform.
fn surface(body: &BodySurface) -> Value {
    let corners: Vec<Vec3> = body.points().collect();
    let [x, y, z] = coordinates(&corners);
    let every_third = |from: usize| (from..corners.len()).step_by(3).collect::<Vec<usize>>();
    json!({
        "type": "mesh3d", "x": x, "y": y, "z": z, "color": "#999999", "opacity": 0.35, "flatshading": true,
        "i": every_third(0), "j": every_third(1), "k": every_third(2),
        "hovertemplate": format!("{}<extra></extra>", plain(&body.name)),
        // For the script that saves the figure as lines.
        "meta": {"faces": (0..body.triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>()},
    })
}

/// Body spanned by the attachments: a polygon if they lie in a plane, otherwise their convex hull.
fn body(points: &[Vec3], reach: f64) -> Value {
    let [x, y, z] = coordinates(points);
    let mut mesh = json!({
        "type": "mesh3d", "x": x, "y": y, "z": z, "color": "#555555", "opacity": 0.55, "flatshading": true,
        "hoverinfo": "skip",
        // For the script that saves the figure as lines; plotly computes the hull itself.
        "meta": {"faces": faces(points)},
    });
    match polygon(points, reach) {
        Some(order) => {
            let (first, rest) = (order[0], &order[1..]);
            mesh["i"] = json!(vec![first; rest.len().saturating_sub(1)]);
            mesh["j"] = json!(&rest[..rest.len().saturating_sub(1)]);
            mesh["k"] = json!(&rest[1.min(rest.len())..]);
        }
        None => mesh["alphahull"] = json!(0),
    }
    mesh
}
