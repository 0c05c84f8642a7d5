//! The tables of a scene about a bladed disk: `[disk]`, the disk itself, and `[disk_start]`, how its blades start.

use super::case::Refusal;
use super::description::{Initial, Scene};
use super::error::Fault;
use crate::model::{BladedDisk, NodalDiameter, ParameterError, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A travelling wave of the blades: `x_j = amplitude cos(phase - j sigma)`, with the velocity of angular frequency 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveStart {
    /// Signed, `-N/2 < n <= N/2`: positive runs to higher blade numbers.
    pub nodal_diameter: i64,
    pub amplitude: f64,
    /// Rad.
    #[serde(default)]
    pub phase: f64,
}

/// How the blades start: waves, and random displacements from `-noise` to `noise`. Contacts start without force, disk segments at rest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DiskStart {
    pub waves: Vec<WaveStart>,
    pub noise: f64,
    pub seed: u64,
}

/// A disk that can be built, and its start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiskCase {
    pub disk: BladedDisk,
    pub start: DiskStart,
}

impl Scene {
    pub(super) fn disk_case(&self) -> Result<Option<DiskCase>, Refusal> {
        let Some(disk) = &self.disk else {
            let alone = self.disk_start.as_ref().map(|_| ("disk_start".to_owned(), Fault::StartWithoutDisk));
            return alone.map_or(Ok(None), Err);
        };
        let others = [
            ("rig", self.rig.is_some()),
            ("rig_si", self.rig_si.is_some()),
            ("initial", self.initial != Initial::default()),
            ("prescribed", self.prescribed.is_some()),
        ];
        if let Some((other, _)) = others.into_iter().find(|(_, given)| *given) {
            return Err((other.to_owned(), Fault::DiskWith { other }));
        }
        disk.chain().map_err(in_disk)?;
        let start = self.disk_start.clone().unwrap_or_default();
        let field = |path: &str, range: Range, value| range.check(path, value).map_err(|f| (path.to_owned(), f.into()));
        field("disk_start.noise", Range::NonNegative, start.noise)?;
        for (number, wave) in start.waves.iter().enumerate() {
            let path = format!("disk_start.waves[{number}].nodal_diameter");
            NodalDiameter::checked("nodal_diameter", wave.nodal_diameter, disk.sectors)
                .map_err(|f| (path, f.into()))?;
            field("disk_start.waves", Range::Finite, wave.amplitude)?;
            field("disk_start.waves", Range::Finite, wave.phase)?;
        }
        Ok(Some(DiskCase { disk: disk.clone(), start }))
    }
}

/// The place of a fault in the description of the disk.
fn in_disk(fault: ParameterError) -> Refusal {
    let path = match &fault {
        ParameterError::NoSuchWave { field, .. } => format!("disk.{field}"),
        _ => "disk".to_owned(),
    };
    (path, fault.into())
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    fn message(text: &str) -> String {
        Scene::parse(text, "disk.toml").unwrap_err().to_string()
    }

    #[test]
    fn a_disk_stands_alone_and_faults_name_their_table() {
        let disk = "title = \"x\"\n[disk]\nsectors = 12\ncoupling = 0.1\n";
        let (_, case) = Scene::parse(disk, "disk.toml").unwrap();
        assert_eq!(case.disk.unwrap().disk.sectors, 12);
        assert!(message(&format!("{disk}[rig]\nxi1 = -0.1\n")).contains("remove [rig]"));
        assert!(message("title = \"x\"\n[disk]\nsectors = 2\n").contains("line 2, field disk: sectors = 2"));
        assert!(message(&format!("{disk}[disk_start]\nnoise = -1.0\n")).contains("field disk_start.noise"));
        assert!(message("title = \"x\"\n[disk_start]\nnoise = 0.1\n").contains("add [disk]"));
    }
    #[test]
    fn waves_that_a_ring_does_not_have_are_refused_with_their_line_and_range() {
        let disk = "title = \"x\"\n[disk]\nsectors = 12\n";
        for n in [99, -6, 7] {
            let wave = format!("[[disk_start.waves]]\nnodal_diameter = {n}\namplitude = 1.0\n");
            let found = message(&format!("{disk}{wave}"));
            let place = "line 4, field disk_start.waves[0].nodal_diameter: ";
            let fault = format!("nodal_diameter = {n} is not allowed: it must be a whole number from -5 to 6");
            assert!(found.contains(&format!("{place}{fault}")), "{found}");
        }
        // Negative control: the outermost ones are there.
        for n in [-5, 6] {
            let wave = format!("[disk_start]\nwaves = [{{ nodal_diameter = {n}, amplitude = 1.0 }}]\n");
            assert!(Scene::parse(&format!("{disk}{wave}"), "disk.toml").is_ok());
        }
    }

    #[test]
    fn a_harmonic_of_negative_order_is_refused_with_its_field() {
        let mistuning = "[disk.mistuning]\nkind = \"harmonics\"\nharmonics = [{ order = -1, amplitude = 0.1 }]\n";
        let found = message(&format!("title = \"x\"\n[disk]\nsectors = 12\n{mistuning}"));
        assert!(found.contains("line 6, field disk.mistuning.harmonics[0].order: "), "{found}");
        assert!(found.contains("order = -1 is not allowed") && found.contains("from 0 to 6"), "{found}");
    }
}
