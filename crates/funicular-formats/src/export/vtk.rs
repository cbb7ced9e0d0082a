//! Export of the equilibrium shape and the modes as VTK XML (`.vtp`), for ParaView: polylines for the cables, triangles
//! for the platform.

use super::modes_below;
use super::xml_text::in_comment;
use anyhow::Result;
use funicular::cable_motion::CableStations;
use funicular::dynamics::Dynamics;
use funicular::math::{Vec3, Vec6};
use funicular::modes::Mode;
use funicular_study::at_rest::AtRest;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::fmt::Write as _;
use std::io;

/// Points and cells of the file, cables first.
struct VtkCells {
    points_w: Vec<Vec3>,
    tension: Vec<f64>,
    arc_length: Vec<f64>,
    /// Owner of each cell: number of the cable from one in the order of the file, or zero for the platform.
    part: Vec<usize>,
    /// Displacement of every point in each mode, with its name.
    modes: Vec<(String, Vec<Vec3>)>,
    polylines: Vec<Vec<usize>>,
    triangles: Vec<[usize; 3]>,
}

/// Writes the file: a curve of `segments` pieces per cable, and with a limit [Hz] a field of vectors per mode below it.
///
/// # Errors
/// Too many modes for a file, or cables that cannot be discretised.
pub(crate) fn poly_data(
    at_rest: &AtRest,
    segments: usize,
    below_hz: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<String> {
    let at_rest = &*at_rest.vibrating();
    let mut shape = VtkCells::at_rest(at_rest, segments);
    if let Some(limit) = below_hz {
        let (dynamics, found) = modes_below(at_rest, limit, warnings)?;
        let stations = stations(at_rest, &dynamics, segments)?;
        for (i, mode) in found.modes.iter().enumerate() {
            let name = format!("mode_{:03}_{:.4}_Hz", i + 1, mode.frequency_hz);
            shape.modes.push((name, displacements(at_rest, &dynamics, &stations, mode)));
        }
    }
    let mut out = Writer::new_with_indent(Vec::new(), b' ', 1);
    shape.write(&mut out, &at_rest.robot.name)?;
    Ok(String::from_utf8(out.into_inner())? + "\n")
}

fn stations(at_rest: &AtRest, dynamics: &Dynamics, segments: usize) -> Result<Vec<CableStations>> {
    let fractions: Vec<f64> = (0..=segments).map(|i| i as f64 / segments as f64).collect();
    let of = |i| Ok(CableStations::new(&at_rest.robot, &at_rest.equilibrium, dynamics, i, &fractions, false)?);
    (0..at_rest.robot.cables.len()).map(of).collect()
}

/// Displacements of all points in a mode: first along every cable, then of the attachments.
fn displacements(at_rest: &AtRest, dynamics: &Dynamics, stations: &[CableStations], mode: &Mode) -> Vec<Vec3> {
    let mut all = Vec::new();
    for of in stations {
        let axes = &of.axes;
        let in_world = |[e, n, b]: [f64; 3]| axes.e * e + axes.n * n + axes.b * b;
        all.extend(of.in_mode(dynamics, mode).into_iter().map(in_world));
    }
    let shape = Vec6::from(mode.shape);
    let turn = Vec3::new(shape[3], shape[4], shape[5]);
    let moved = |lever_w: &Vec3| Vec3::new(shape[0], shape[1], shape[2]) + turn.cross(lever_w);
    all.extend(at_rest.equilibrium.cables.iter().map(|cable| moved(&cable.lever_w)));
    all
}

impl VtkCells {
    fn at_rest(at_rest: &AtRest, segments: usize) -> Self {
        let mut shape = Self {
            points_w: Vec::new(),
            tension: Vec::new(),
            arc_length: Vec::new(),
            part: Vec::new(),
            modes: Vec::new(),
            polylines: Vec::new(),
            triangles: Vec::new(),
        };

        for (i, cable) in at_rest.equilibrium.cables.iter().enumerate() {
            let first = shape.points_w.len();
            let hanging = cable.hanging.as_ref().expect("cables hang in an export");

            for k in 0..=segments {
                let s = cable.free_length() * k as f64 / segments as f64;
                shape.points_w.push(hanging.point_w(s));
                shape.tension.push(hanging.catenary.tension_at(s));
                shape.arc_length.push(s);
            }

            shape.polylines.push((first..shape.points_w.len()).collect());
            shape.part.push(i + 1);
        }

        let first = shape.points_w.len();
        let attachments: Vec<Vec3> = at_rest.equilibrium.cables.iter().map(|cable| cable.attachment_w).collect();
        shape.triangles = hull(&attachments).into_iter().map(|corners| corners.map(|i| first + i)).collect();

        shape.part.extend(shape.triangles.iter().map(|_| 0));

        shape.tension.resize(first + attachments.len(), 0.0);
        shape.arc_length.resize(first + attachments.len(), 0.0);
        shape.points_w.extend(attachments);
        shape
    }

    /// Writes the file.
    fn write(&self, out: &mut Writer<Vec<u8>>, name: &str) -> Result<()> {
        out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let title = format!(" {}; written by funicular export ", in_comment(name));
        out.write_event(Event::Comment(BytesText::from_escaped(title)))?;

        let root = [("type", "PolyData"), ("version", "1.0"), ("byte_order", "LittleEndian")];
        out.create_element("VTKFile").with_attributes(root).write_inner_content(|out| {
            out.create_element("PolyData").write_inner_content(|out| self.write_piece(out))?;
            Ok(())
        })?;
        Ok(())
    }

    /// Writes points and cells with their data.
    fn write_piece(&self, out: &mut Writer<Vec<u8>>) -> io::Result<()> {
        let triangles: Vec<Vec<usize>> = self.triangles.iter().map(|corners| corners.to_vec()).collect();
        let sizes = [
            ("NumberOfPoints", self.points_w.len()),
            ("NumberOfVerts", 0),
            ("NumberOfLines", self.polylines.len()),
            ("NumberOfStrips", 0),
            ("NumberOfPolys", triangles.len()),
        ];
        let sizes = sizes.map(|(key, count)| (key, count.to_string()));
        let sizes = sizes.iter().map(|(key, value)| (*key, value.as_str()));

        out.create_element("Piece").with_attributes(sizes).write_inner_content(|out| {
            out.create_element("Points")
                .write_inner_content(|out| array(out, "Float64", "position_m", Some(3), &vectors(&self.points_w)))?;
            out.create_element("PointData").write_inner_content(|out| {
                array(out, "Float64", "tension_n", None, &numbers(&self.tension))?;
                array(out, "Float64", "arc_length_m", None, &numbers(&self.arc_length))?;
                self.modes.iter().try_for_each(|(name, by)| array(out, "Float64", name, Some(3), &vectors(by)))
            })?;
            out.create_element("CellData")
                .write_inner_content(|out| array(out, "Int32", "cable", None, &listed(self.part.iter())))?;
            write_cells(out, "Lines", &self.polylines)?;
            write_cells(out, "Polys", &triangles)
        })?;
        Ok(())
    }
}

/// Writes cells as VTK has them: the points of all cells in one list, and the end of each cell in this list.
fn write_cells(out: &mut Writer<Vec<u8>>, kind: &str, cells: &[Vec<usize>]) -> io::Result<()> {
    let ends: Vec<usize> = cells
        .iter()
        .scan(0, |end, cell| {
            *end += cell.len();
            Some(*end)
        })
        .collect();
    out.create_element(kind).write_inner_content(|out| {
        array(out, "Int64", "connectivity", None, &listed(cells.iter().flatten()))?;
        array(out, "Int64", "offsets", None, &listed(ends.iter()))
    })?;
    Ok(())
}

fn array(out: &mut Writer<Vec<u8>>, kind: &str, name: &str, components: Option<usize>, text: &str) -> io::Result<()> {
    let components = components.map(|n| n.to_string());
    let mut attributes = vec![("type", kind), ("Name", name), ("format", "ascii")];
    attributes.extend(components.as_deref().map(|n| ("NumberOfComponents", n)));
    out.create_element("DataArray").with_attributes(attributes).write_text_content(BytesText::from_escaped(text))?;
    Ok(())
}

/// Text of numbers with all digits.
fn numbers(values: &[f64]) -> String {
    values.iter().fold(String::new(), |mut text, value| {
        let _ = write!(text, "{:e} ", value + 0.0);
        text
    })
}

fn vectors(values: &[Vec3]) -> String {
    values.iter().map(|value| numbers(value.as_slice())).collect()
}

fn listed<'a>(values: impl Iterator<Item = &'a usize>) -> String {
    values.fold(String::new(), |mut text, value| {
        let _ = write!(text, "{value} ");
        text
    })
}

/// Triangles of the convex hull of points: all triangles with every point on one side. Triangles of a face with more
/// than three points overlap; if all points lie in one plane, every triangle is a face.
fn hull(points: &[Vec3]) -> Vec<[usize; 3]> {
    // The search takes n⁴ steps; a platform has about ten attachments.
    const MAX_POINTS: usize = 40;
    let n = points.len();
    if n > MAX_POINTS {
        return Vec::new();
    }

    let reach = points.iter().map(|point| (point - points[0]).norm()).fold(0.0, f64::max);
    let mut faces = Vec::new();

    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let normal = (points[j] - points[i]).cross(&(points[k] - points[i]));
                let thin = 1e-6 * reach * reach;
                let side = |point: &Vec3| (point - points[i]).dot(&normal);
                let flat = 1e-6 * reach * normal.norm();
                let (above, below) = (points.iter().any(|p| side(p) > flat), points.iter().any(|p| side(p) < -flat));
                if normal.norm() > thin && !(above && below) {
                    faces.push([i, j, k]);
                }
            }
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_with_a_point_inside_has_four_faces_and_a_line_has_none() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.1, 0.1]];
        let points: Vec<Vec3> = corners.into_iter().map(Vec3::from).collect();
        let faces = hull(&points);
        assert_eq!(faces, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]);
        let line: Vec<Vec3> = (0..5).map(|i| Vec3::new(f64::from(i), 0.0, 0.0)).collect();
        assert!(hull(&line).is_empty());
        assert!(hull(&[Vec3::zeros(); 8]).is_empty());
    }
}
