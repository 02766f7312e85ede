//! Every item, chapter by chapter: one file for each table or figure, or for a few that belong together.

mod counts;
mod depth_range;
mod depth_resolution;
mod drawings;
mod estimator;
mod failures;
mod histograms;
mod laser;
mod network;
mod optics;
mod oscilloscope;
mod parameters;
mod peak;
mod subtraction;
mod tdc;
mod words;

use super::item::Item;

/// All items, those of a chapter together, and in its order: equations, listings and others before tables, these before
/// figures.
pub fn all() -> Vec<&'static Item> {
    let groups: [&'static [Item]; 16] = [
        &optics::ITEMS,
        &histograms::ITEMS,
        &parameters::ITEMS,
        &depth_range::ITEMS,
        &depth_resolution::ITEMS,
        &failures::ITEMS,
        &peak::ITEMS,
        &subtraction::ITEMS,
        &network::ITEMS,
        &laser::ITEMS,
        &oscilloscope::ITEMS,
        &tdc::ITEMS,
        &counts::ITEMS,
        &words::ITEMS,
        &estimator::ITEMS,
        &drawings::ITEMS,
    ];
    let mut items: Vec<_> = groups.into_iter().flatten().collect();
    items.sort_by_key(|item| order(item.id));
    items
}

/// Chapter, kind, number and letter of an item.
fn order(id: &str) -> (u32, u32, u32, &str) {
    let (kind, place) = id.split_once('-').unwrap_or((id, "6"));
    let (chapter, rest) = place.split_once('.').unwrap_or((place, "0"));
    let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let kind = ["eq", "listing", "clocks", "table", "fig"].iter().position(|known| *known == kind);
    let number = |text: &str| text.parse().unwrap_or(0);
    (number(chapter), kind.unwrap_or(9) as u32, number(&rest[..digits]), &rest[digits..])
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_item_has_a_name_of_its_own_and_they_are_in_the_order_of_the_thesis() {
        let ids: Vec<_> = all().iter().map(|item| item.id).collect();
        assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());
        let at = |id: &str| ids.iter().position(|known| *known == id).unwrap();
        let rising = [
            "fig-2.1",
            "eq-3.3",
            "table-3.2",
            "fig-4.1",
            "table-5.2",
            "fig-5.7a",
            "fig-5.7b",
            "table-6.5",
            "fig-6.9",
            "fig-6.10",
            "fig-6.21",
        ];
        assert!(rising.windows(2).all(|pair| at(pair[0]) < at(pair[1])), "{ids:?}");
    }

    #[test]
    fn every_numbered_table_and_figure_is_there() {
        let tables = [
            "3.1", "3.2", "4.1", "4.2", "4.3", "5.1", "5.2", "5.3", "5.4", "5.5", "6.1", "6.2",
            "6.3", "6.4", "6.5",
        ];
        let figures = [("2.", 4), ("3.", 3), ("4.", 9), ("5.", 7), ("6.", 21)];
        let figures = figures.iter().flat_map(|(chapter, last)| {
            (1..=*last).map(move |number| format!("fig-{chapter}{number}"))
        });
        let wanted = tables.iter().map(|table| format!("table-{table}")).chain(figures);
        for id in wanted {
            let parts = [id.clone(), format!("{id}a"), format!("{id}b")];
            let there =
                all().iter().filter(|item| parts.iter().any(|part| part == item.id)).count();
            assert!(there >= 1, "{id}");
        }
    }
}
