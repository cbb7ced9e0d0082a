//! Programs and files that robots are exported to.

use super::Named;

named! {
    /// Programs that robots can be exported to.
    enum ExportFormat, "format of export" {
        Opensees "opensees", "Python script for OpenSeesPy";
        Moordyn "moordyn", "Input file of version 2";
        Mujoco "mujoco", "Model in MJCF, with winches as actuators";
        Sdf "sdf", "World of Gazebo, whose cables Drake reads as springs";
        Urdf "urdf", "Frame and platform for viewers";
        Vtk "vtk", "VTK XML of polylines and polygons (.vtp), for ParaView";
        C "c", "Table of lengths over a box of poses as a C99 file, for firmware";
        Json "json", "Table of lengths over a box of poses in JSON, for firmware that reads its numbers";
        Fmu "fmu", "Robot in motion as a Functional Mock-up Unit 2.0 for co-simulation";
        Fmu3 "fmu3", "Robot in motion as a Functional Mock-up Unit 3.0 for co-simulation";
    }
}

impl ExportFormat {
    /// Name of the program as its authors write it.
    pub fn program(self) -> &'static str {
        match self {
            Self::Opensees => "OpenSees",
            Self::Moordyn => "MoorDyn",
            Self::Mujoco => "MuJoCo",
            Self::Sdf => "Gazebo",
            Self::Urdf => "URDF",
            Self::Vtk => "VTK",
            Self::C => "C",
            Self::Json => "JSON",
            Self::Fmu => "FMI 2.0",
            Self::Fmu3 => "FMI 3.0",
        }
    }

    /// True if the file is a table of lengths over a box of poses.
    pub fn is_length_table(self) -> bool {
        matches!(self, Self::C | Self::Json)
    }

    /// True if the file is a unit of co-simulation, which has the robot in motion.
    pub fn is_unit(self) -> bool {
        matches!(self, Self::Fmu | Self::Fmu3)
    }

    /// True if cables of the program are straight springs without mass, with the static model `spring`.
    pub fn has_straight_cables(self) -> bool {
        matches!(self, Self::Mujoco | Self::Sdf | Self::Urdf)
    }

    /// True if the file can hold or compare modes.
    pub fn has_modes(self) -> bool {
        matches!(self, Self::Opensees | Self::Vtk)
    }
}
