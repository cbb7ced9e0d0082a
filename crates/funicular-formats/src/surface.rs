//! Surfaces of workspaces as files of other programs: STL, PLY and VTK.

use anyhow::Result;
use funicular::proof::FaceMesh;
use funicular_study::analyses::workspace::Workspace;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::fmt::Write as _;
use std::io;

/// Format of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceFormat {
    /// Binary STL, whose numbers have seven digits [m].
    Stl,
    /// Polygon File Format of Stanford, as text with every digit [m].
    Ply,
    /// Polygons of VTK for ParaView, as text with every digit [m]. The number `cut` of a triangle is 1 on the box of
    /// the grid and 0 on the surface of the set.
    Vtp,
}

impl SurfaceFormat {
    /// Every format with the ending of its files.
    pub const ALL: [(Self, &'static str); 3] = [(Self::Stl, "stl"), (Self::Ply, "ply"), (Self::Vtp, "vtp")];

    /// Format of files with an ending, upper or lower case.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, own)| ending.eq_ignore_ascii_case(own)).map(|(format, _)| format)
    }
}

/// Surface of a workspace in a format.
///
/// # Errors
/// None that the memory does not give.
pub fn of_workspace(found: &Workspace, format: SurfaceFormat) -> Result<Vec<u8>> {
    let Workspace { vertices_m, triangles, triangles_of_surface, .. } = found;
    Surface { vertices_m, triangles, before_cut: *triangles_of_surface }.written(format)
}

/// Closed surface: vertices, triangles by their numbers, and the number of triangles before those on a box.
struct Surface<'a> {
    vertices_m: &'a [[f64; 3]],
    triangles: &'a [[usize; 3]],
    before_cut: usize,
}

impl Surface<'_> {
    fn written(&self, format: SurfaceFormat) -> Result<Vec<u8>> {
        match format {
            SurfaceFormat::Stl => stl(self),
            SurfaceFormat::Ply => Ok(ply(self).into_bytes()),
            SurfaceFormat::Vtp => vtp(self),
        }
    }
}

/// Surface of what is proved inside, in a format.
///
/// # Errors
/// None that the memory does not give.
pub fn of_proof(mesh: &FaceMesh, format: SurfaceFormat) -> Result<Vec<u8>> {
    let vertices: Vec<[f64; 3]> = mesh.vertices.iter().map(|vertex| (*vertex).into()).collect();
    let surface = Surface { vertices_m: &vertices, triangles: &mesh.triangles, before_cut: usize::MAX };
    surface.written(format)
}

fn stl(found: &Surface<'_>) -> Result<Vec<u8>> {
    let vertex = |i: usize| found.vertices_m[i].map(|coordinate| coordinate as f32);
    let triangles: Vec<stl_io::Triangle> = (found.triangles.iter())
        .map(|corners| {
            let vertices = corners.map(vertex);
            stl_io::Triangle {
                normal: stl_io::Normal::new(normal(vertices)),
                vertices: vertices.map(stl_io::Vertex::new),
            }
        })
        .collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, triangles.iter())?;
    Ok(bytes)
}

/// Unit normal of a triangle; zero for one without an area, from which readers compute none.
fn normal([a, b, c]: [[f32; 3]; 3]) -> [f32; 3] {
    let side = |to: [f32; 3]| [0, 1, 2].map(|k| f64::from(to[k]) - f64::from(a[k]));
    let ([ux, uy, uz], [vx, vy, vz]) = (side(b), side(c));
    let cross = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    let length = cross.iter().map(|part| part * part).sum::<f64>().sqrt();
    cross.map(|part| if length > 0.0 { (part / length) as f32 } else { 0.0 })
}

fn ply(found: &Surface<'_>) -> String {
    let mut text = format!(
        "ply\nformat ascii 1.0\ncomment workspace in metres\nelement vertex {}\nproperty double x\nproperty double \
         y\nproperty double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        found.vertices_m.len(),
        found.triangles.len()
    );
    for [x, y, z] in found.vertices_m {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    for [a, b, c] in found.triangles {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    text
}

fn vtp(found: &Surface<'_>) -> Result<Vec<u8>> {
    let (vertices, triangles) = (found.vertices_m.len(), found.triangles.len());
    let mut out = Writer::new(Vec::new());
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let root = [("type", "PolyData"), ("version", "1.0"), ("byte_order", "LittleEndian")];
    out.write_event(Event::Start(BytesStart::new("VTKFile").with_attributes(root)))?;
    out.write_event(Event::Start(BytesStart::new("PolyData")))?;
    let [points, polygons] = [vertices, triangles].map(|count| count.to_string());
    let counts = [("NumberOfPoints", points.as_str()), ("NumberOfPolys", &polygons)];
    out.write_event(Event::Start(BytesStart::new("Piece").with_attributes(counts)))?;

    out.write_event(Event::Start(BytesStart::new("CellData")))?;
    let is_cut = |i: usize| u8::from(i >= found.before_cut);
    array(&mut out, ("UInt8", "cut", 1), (0..triangles).map(is_cut))?;
    out.write_event(Event::End(BytesEnd::new("CellData")))?;

    out.write_event(Event::Start(BytesStart::new("Points")))?;
    array(&mut out, ("Float64", "Points", 3), found.vertices_m.iter().flatten())?;
    out.write_event(Event::End(BytesEnd::new("Points")))?;

    out.write_event(Event::Start(BytesStart::new("Polys")))?;
    array(&mut out, ("Int64", "connectivity", 1), found.triangles.iter().flatten())?;
    array(&mut out, ("Int64", "offsets", 1), (1..=triangles).map(|count| 3 * count))?;
    out.write_event(Event::End(BytesEnd::new("Polys")))?;

    for name in ["Piece", "PolyData", "VTKFile"] {
        out.write_event(Event::End(BytesEnd::new(name)))?;
    }
    let mut bytes = out.into_inner();
    bytes.push(b'\n');
    Ok(bytes)
}

/// Numbers of VTK: type, name, and number of components of each.
fn array<T: std::fmt::Display>(
    out: &mut Writer<Vec<u8>>,
    (kind, name, components): (&str, &str, usize),
    numbers: impl Iterator<Item = T>,
) -> io::Result<()> {
    let components = components.to_string();
    let attributes = [("type", kind), ("Name", name), ("NumberOfComponents", components.as_str()), ("format", "ascii")];
    out.write_event(Event::Start(BytesStart::new("DataArray").with_attributes(attributes)))?;
    let mut text = String::new();
    for number in numbers {
        let _ = write!(text, "{number} ");
    }
    out.write_event(Event::Text(BytesText::new(text.trim_end())))?;
    out.write_event(Event::End(BytesEnd::new("DataArray")))
}
