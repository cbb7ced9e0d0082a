//! Rope that runs over sheaves of the platform and the frame: several cables with one unstrained length.

use super::Robot;

/// One rope that is several cables, as the falls of a block and tackle: it runs over a sheave on the platform from the
/// first cable into the second, over a sheave on the frame into the third, and so on.
///
/// The sum of the unstrained lengths of its cables is given; the rope divides it among them. Over sheaves without
/// friction the sum ψ(T) + q·p of [`drive`](crate::drive) is equal in all of its cables: two cables that end at one
/// point of the platform have the same tension there. Sheaves have no mass of their own; the mass of a block is part of
/// the platform.
#[derive(Debug, Clone, PartialEq)]
pub struct RopeOverSheaves {
    /// Indices of its cables, in their order along the rope; two at least.
    pub cables: Vec<usize>,
    /// Efficiency of the sheave between each cable and the next one: smaller over larger tension while the rope runs,
    /// in (0, 1].
    pub efficiencies: Vec<f64>,
}

impl RopeOverSheaves {
    /// Cables between which rope runs in a small motion: a sheave with friction stays at rest in it. Parts of one cable
    /// are left out.
    pub fn running_parts(&self) -> Vec<&[usize]> {
        let mut parts = Vec::new();
        let mut first = 0;
        for (sheave, efficiency) in self.efficiencies.iter().enumerate() {
            if *efficiency < 1.0 {
                parts.push(&self.cables[first..=sheave]);
                first = sheave + 1;
            }
        }
        parts.push(&self.cables[first..]);
        parts.retain(|part| part.len() > 1);
        parts
    }
}

impl Robot {
    /// Number of ropes: cables of one rope over sheaves count as one.
    pub fn rope_count(&self) -> usize {
        self.cables.len() - self.ropes.iter().map(|rope| rope.cables.len() - 1).sum::<usize>()
    }

    /// True if a rope runs over sheaves into several cables.
    pub fn has_ropes_over_sheaves(&self) -> bool {
        !self.ropes.is_empty()
    }

    /// True if rope runs between cables in a small motion.
    pub(crate) fn has_running_ropes(&self) -> bool {
        self.ropes.iter().any(|rope| !rope.running_parts().is_empty())
    }

    /// Indices of the cables of each rope, in the order of their first cables.
    pub fn cables_of_ropes(&self) -> Vec<Vec<usize>> {
        let of = |i: usize| self.ropes.iter().find(|rope| rope.cables.contains(&i));
        let is_first = |i: usize, rope: &RopeOverSheaves| rope.cables.iter().all(|cable| *cable >= i);
        (0..self.cables.len())
            .filter_map(|i| match of(i) {
                None => Some(vec![i]),
                Some(rope) => is_first(i, rope).then(|| rope.cables.clone()),
            })
            .collect()
    }
}
