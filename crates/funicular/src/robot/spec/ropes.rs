//! Cables that share one rope: their order along it, and the conditions between them.

use super::cables::CableEntry;
use super::read::{Reader, shortened};
use crate::robot::RopeOverSheaves;
use crate::suggest::nearest;

/// Ropes over sheaves, from the names that cables give. Refuses what is not one rope.
pub(super) fn of(reader: &mut Reader, entries: &[CableEntry]) -> Vec<RopeOverSheaves> {
    let name = |entry: &CableEntry| entry.cable.as_ref().map(|cable| cable.name.clone());
    let names: Vec<Option<String>> = entries.iter().map(name).collect();
    let mut before: Vec<Option<usize>> = vec![None; entries.len()];
    for (i, entry) in entries.iter().enumerate() {
        let Some((wanted, span)) = &entry.shares else { continue };
        let Some(first) = names.iter().position(|name| name.as_ref() == Some(wanted)) else {
            // Cables that were refused have been reported.
            if names.iter().all(Option::is_some) {
                let near = nearest(wanted, names.iter().flatten().map(String::as_str));
                let near = near.map(|near| format!("did you mean \"{}\"? ", shortened(near))).unwrap_or_default();
                reader
                    .issue(span.clone(), format!("there is no cable \"{}\"", shortened(wanted)))
                    .help(format!("{near}`shares_rope_with` is the name of another cable"));
            }
            continue;
        };
        if let Some((other, _)) = before.iter().enumerate().find(|(_, before)| **before == Some(first)) {
            let place = entries[other].shares.as_ref().map_or(span.clone(), |(_, place)| place.clone());
            reader
                .issue(span.clone(), format!("two cables continue the rope of cable \"{}\"", shortened(wanted)))
                .context(place, "the first is here")
                .help("name the cables in their order along the rope: \"2\" shares with \"1\", \"3\" with \"2\"");
            continue;
        }
        before[i] = Some(first);
        check_pair(reader, &entries[first], entry, span);
    }

    // Follow each rope from the cable that continues none.
    let mut ropes = Vec::new();
    let mut used = vec![false; entries.len()];
    for start in (0..entries.len()).filter(|i| before[*i].is_none()) {
        let mut rope = RopeOverSheaves { cables: vec![start], efficiencies: Vec::new() };
        while let Some(next) = before.iter().position(|of| *of == rope.cables.last().copied()) {
            rope.cables.push(next);
            rope.efficiencies.push(entries[next].efficiency);
        }
        rope.cables.iter().for_each(|i| used[*i] = true);
        if rope.cables.len() > 1 {
            ropes.push(rope);
        }
    }
    if let Some((_, span)) =
        entries.iter().zip(used).find(|(_, used)| !used).and_then(|(entry, _)| entry.shares.clone())
    {
        reader
            .issue(span, "this rope has no end: its cables continue each other in a circle")
            .help("remove `shares_rope_with` from the cable at one end of the rope");
    }
    refuse_supports(reader, entries, &ropes);
    ropes
}

/// Refuses two cables that cannot be one rope.
fn check_pair(reader: &mut Reader, first: &CableEntry, entry: &CableEntry, span: &std::ops::Range<usize>) {
    let (Some(first), Some(next)) = (&first.cable, &entry.cable) else { return };
    if first.material != next.material {
        reader
            .issue(span.clone(), format!("cable \"{}\" is of another rope", shortened(&first.name)))
            .help("cables that share one rope have the same `material`");
    } else if first.load_per_length_w != next.load_per_length_w {
        reader
            .issue(span.clone(), format!("cable \"{}\" bears another load along it", shortened(&first.name)))
            .help("cables that share one rope have the same `load_n_per_m`");
    }
}

/// Refuses flexible supports beside ropes over sheaves.
fn refuse_supports(reader: &mut Reader, entries: &[CableEntry], ropes: &[RopeOverSheaves]) {
    let Some(span) = entries.iter().find_map(|entry| entry.support_span.clone()).filter(|_| !ropes.is_empty()) else {
        return;
    };
    let shared = ropes.iter().flat_map(|rope| &rope.cables).find_map(|i| entries[*i].shares.clone());
    let issue = reader.issue(span, "flexible supports beside a rope over sheaves are not computed");
    if let Some((_, place)) = shared {
        issue.context(place, "the rope over a sheave is here");
    }
    issue.help("remove `support` from the cables, or `shares_rope_with`");
}
