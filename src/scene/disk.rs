//! The tables of a scene about a bladed disk: `[disk]`, the disk itself, and `[disk_start]`, how its blades start.

use super::case::Refusal;
use super::description::{Initial, Scene};
use super::error::Fault;
use crate::model::{BladedDisk, Range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A travelling wave of the blades: `x_j = amplitude cos(phase - j sigma)`, with the velocity of angular frequency 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveStart {
    /// Signed: positive runs to higher blade numbers.
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
        disk.chain().map_err(|fault| ("disk".to_owned(), fault.into()))?;
        let start = self.disk_start.clone().unwrap_or_default();
        let field = |path: &str, range: Range, value| range.check(path, value).map_err(|f| (path.to_owned(), f.into()));
        field("disk_start.noise", Range::NonNegative, start.noise)?;
        for wave in &start.waves {
            field("disk_start.waves", Range::Finite, wave.amplitude)?;
            field("disk_start.waves", Range::Finite, wave.phase)?;
        }
        Ok(Some(DiskCase { disk: disk.clone(), start }))
    }
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
}
