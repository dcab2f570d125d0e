//! Along what samples are differentiated.

use crate::error::{Error, Result};

/// Which load coefficients and which stiffnesses change along each direction.
#[derive(Debug, Clone)]
pub struct Directions {
    pub count: usize,
    /// (direction, pattern)
    pub loads: Vec<(usize, usize)>,
    /// (direction, stiffness)
    pub changes: Vec<(usize, usize)>,
}

impl Directions {
    pub(crate) fn check(&self, patterns: usize, stiffnesses: usize) -> Result<()> {
        for (name, entries, end) in [
            ("loads", &self.loads, patterns),
            ("changes", &self.changes, stiffnesses),
        ] {
            let outside =
                |&&(direction, entry): &&(usize, usize)| direction >= self.count || entry >= end;
            if let Some((direction, entry)) = entries.iter().find(outside) {
                return Err(Error::invalid(format!(
                    "{name} of the directions name entry {entry} of direction {direction}, of \
                     {end} entries and {} directions",
                    self.count
                )));
            }
        }
        Ok(())
    }
}
