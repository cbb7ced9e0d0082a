//! Import of MoorDyn input files (versions 1 and 2) with one body, one free point, or coupled points, held by lines.
//!
//! # References
//!
//! moordyn.readthedocs.io, "Input files", version 2.7. A run of MoorDyn 2.7.2 confirmed that angles are degrees about
//! moving axes, x first. The layout of version 1 is that of "The V1 Input File" there.

mod objects;
mod sections;

use super::draft::{Draft, DraftCable, DraftMotion, DraftPlatform, DraftRope, DraftState};
use anyhow::{Result, bail};
use funicular::math::{Mat3, Vec3};
use funicular_study::request::SourceFile;
use funicular_study::text::{clean, counted};
use objects::{Holder, MoorDynLine, MoorDynModel, MoorDynPoint};
use sections::SourceRow;

/// True if a text has the sections of a MoorDyn input file.
pub(crate) fn is_input(text: &str) -> bool {
    sections::is_input(text)
}

/// Reads the robot of a file.
///
/// # Errors
///
/// The line and the value at fault; or the feature of the robot that a robot file cannot hold.
pub(crate) fn read(file: &SourceFile) -> Result<Draft> {
    let mut model = MoorDynModel::read(file)?;
    let (platform, on_platform) = platform(file, &model)?;
    let mut cables = Vec::new();
    let mut lost = std::mem::take(&mut model.lost);
    for line in &model.lines {
        let [a, b] = [model.point(file, line, 0)?, model.point(file, line, 1)?];
        match (holds(on_platform, a), holds(on_platform, b)) {
            (true, false) => cables.push(cable(file, &model, line, on_platform, b, a)?),
            (false, true) => cables.push(cable(file, &model, line, on_platform, a, b)?),
            (false, false) if a.holder == Holder::Fixed && b.holder == Holder::Fixed => {
                lost.push(format!("line {}, which does not hold the platform", line.id));
            }
            (true, true) => {
                bail!(
                    line.row
                        .error(file, format!("line {} has both ends on the platform; give it one fixed end", line.id))
                )
            }
            (false, false) => {
                let free = if a.holder == Holder::Fixed { b } else { a };
                bail!(line.row.error(
                    file,
                    format!(
                        "line {} ends at point {}, which is neither fixed nor on the platform: a cable of a robot file \
                         runs straight from its anchor to the platform",
                        line.id, free.id
                    )
                ))
            }
        }
    }

    if cables.is_empty() {
        bail!("{}: no line holds the platform", file.path);
    }
    let frame = match on_platform {
        PlatformObject::Body(_) => "the body's reference point".to_owned(),
        PlatformObject::Point(_) => "the free point".to_owned(),
        PlatformObject::Coupled(center) => {
            let [x, y, z] = [center.x, center.y, center.z];
            let what = if platform.motion == DraftMotion::PointMass { "point" } else { "points' centre" };
            format!("the coupled {what}, ({x}, {y}, {z}) m in the source")
        }
    };
    if let PlatformObject::Coupled(_) = on_platform {
        note_coupled_points(&mut model, platform.motion, &mut lost);
    }
    Ok(Draft {
        name: file.stem(),
        source: format!("MoorDyn model, {}", file.name()),
        gravity_w: Vec3::new(0.0, 0.0, -model.gravity),
        platform,
        cables,
        payload: None,
        state: DraftState::Lengths,
        notes: vec![format!("Platform frame: at {frame}. The state is the source's unstrained lengths")],
        assumed: model.assumed,
        lost,
    })
}

/// Notes what a platform of coupled points assumes and loses.
fn note_coupled_points(model: &mut MoorDynModel, motion: DraftMotion, lost: &mut Vec<String>) {
    let coupled = || model.points.iter().filter(|point| point.holder == Holder::Coupled);
    let count = counted(coupled().count(), "coupled point");
    let has_mass = coupled().any(|point| point.mass > 0.0);
    model.assumed.push(format!("the platform is the {count}, and is free; in the source another program moves it"));
    if motion == DraftMotion::Rigid {
        model.assumed.push(
            "the centre of mass is the centre of the coupled points, unless ⟪center_of_mass_m⟫ is given".to_owned(),
        );
    }
    if has_mass {
        lost.push("the masses of coupled points: the mass of the platform has to contain them".to_owned());
    }
}

/// Object of the file that is the platform: a body or a point.
#[derive(Clone, Copy)]
enum PlatformObject {
    Body(usize),
    Point(usize),
    /// All coupled points; with their centre, the origin of the platform frame.
    Coupled(Vec3),
}

fn holds(on: PlatformObject, point: &MoorDynPoint) -> bool {
    match on {
        PlatformObject::Body(id) => point.holder == Holder::Body(id),
        PlatformObject::Point(id) => point.id == id,
        PlatformObject::Coupled(_) => point.holder == Holder::Coupled,
    }
}

fn platform(file: &SourceFile, model: &MoorDynModel) -> Result<(DraftPlatform, PlatformObject)> {
    let moving: Vec<&objects::MoorDynBody> = model.bodies.iter().filter(|body| body.is_free).collect();
    if let [body] = moving[..] {
        if let Some(held) = model.bodies.iter().find(|body| !body.is_free) {
            bail!(held.row.error(file, format!("body {} is fixed; remove it from the file", held.id)));
        }
        // Masses of points fixed to the body belong to the body.
        let masses = model.points.iter().filter(|point| point.holder == Holder::Body(body.id));
        let parts: Vec<(f64, Vec3, Mat3)> = std::iter::once((body.mass, body.center_p, body.inertia_p))
            .chain(masses.map(|point| (point.mass, point.position, Mat3::zeros())))
            .filter(|(mass, ..)| *mass > 0.0)
            .collect();

        let mass: f64 = parts.iter().map(|(mass, ..)| mass).sum();
        let center =
            if mass > 0.0 { parts.iter().map(|(part, center, _)| center * (part / mass)).sum() } else { body.center_p };
        let about = |at: &Vec3| Mat3::identity() * at.norm_squared() - at * at.transpose();
        let inertia: Mat3 = parts.iter().map(|(part, at, own)| own + about(&(at - center)) * *part).sum();

        let platform = DraftPlatform {
            mass: (mass > 0.0).then_some(mass),
            inertia_p: (inertia != Mat3::zeros()).then_some(inertia),
            center_of_mass_p: Some(center),
            motion: DraftMotion::Rigid,
            place: body.row.place(file),
        };
        return Ok((platform, PlatformObject::Body(body.id)));
    }
    if let [_, second, ..] = moving[..] {
        let message = format!("the file has {} bodies; a robot has one platform", moving.len());
        bail!(second.row.error(file, message));
    }
    if let Some(body) = model.bodies.first() {
        bail!(body.row.error(file, format!("body {} is fixed, so nothing moves; make it free", body.id)));
    }
    match model.points.iter().filter(|point| point.holder == Holder::Free).collect::<Vec<_>>()[..] {
        [point] => {
            let platform = DraftPlatform {
                mass: (point.mass > 0.0).then_some(point.mass),
                inertia_p: None,
                center_of_mass_p: None,
                motion: DraftMotion::PointMass,
                place: point.row.place(file),
            };
            Ok((platform, PlatformObject::Point(point.id)))
        }
        [] => coupled_platform(file, model),
        [_, second, ..] => {
            bail!(second.row.error(
                file,
                "the file has no body and several free points; a robot has one platform, a body or a point"
            ))
        }
    }
}

/// Platform of the coupled points, which another program moves as one. Their places are those at its start.
fn coupled_platform(file: &SourceFile, model: &MoorDynModel) -> Result<(DraftPlatform, PlatformObject)> {
    let points: Vec<&MoorDynPoint> = model.points.iter().filter(|point| point.holder == Holder::Coupled).collect();
    let [first, ..] = points[..] else {
        bail!("{}: there is no body, no free point and no coupled point: the file has no platform", file.path);
    };
    let center = points.iter().map(|point| point.position).sum::<Vec3>() / points.len() as f64;
    let is_point = points.iter().all(|point| point.position == first.position);
    let platform = DraftPlatform {
        // Coupled points have at most the masses of fittings.
        mass: None,
        inertia_p: None,
        center_of_mass_p: (!is_point).then(Vec3::zeros),
        motion: if is_point { DraftMotion::PointMass } else { DraftMotion::Rigid },
        place: first.row.place(file),
    };
    Ok((platform, PlatformObject::Coupled(if is_point { first.position } else { center })))
}

fn cable(
    file: &SourceFile,
    model: &MoorDynModel,
    line: &MoorDynLine,
    on_platform: PlatformObject,
    anchor: &MoorDynPoint,
    attachment: &MoorDynPoint,
) -> Result<DraftCable> {
    if anchor.holder != Holder::Fixed {
        bail!(line.row.error(
            file,
            format!(
                "line {} ends at point {}, which is not fixed: a cable of a robot file runs straight from its anchor \
                 to the platform",
                line.id, anchor.id
            )
        ));
    }

    let Some(kind) = model.types.iter().find(|kind| kind.word == line.kind) else {
        bail!(
            line.row.error(file, format!("line {} is of type `{}`, which is not defined", line.id, clean(line.kind)))
        );
    };

    Ok(DraftCable {
        name: line.id.to_string(),
        anchor_w: anchor.position,
        attachment_p: match on_platform {
            PlatformObject::Body(_) => attachment.position,
            PlatformObject::Point(_) => Vec3::zeros(),
            PlatformObject::Coupled(center) => attachment.position - center,
        },
        rope: DraftRope {
            name: kind.name.clone(),
            mass_per_length: Some(kind.mass_per_length),
            axial_stiffness: Some(kind.axial_stiffness),
            youngs_modulus: None,
            diameter: None,
            breaking_load: None,
        },
        limits: [None; 2],
        winch: None,
        unstrained_length: Some(line.unstrained_length),
        pulley: None,
    })
}

impl SourceRow<'_> {
    /// `file:line` of the row.
    fn place(&self, file: &SourceFile) -> String {
        format!("{}:{}", file.path, self.line)
    }

    /// An error at the row.
    fn error(&self, file: &SourceFile, message: impl std::fmt::Display) -> anyhow::Error {
        anyhow::anyhow!("{}: {message}", self.place(file))
    }
}
