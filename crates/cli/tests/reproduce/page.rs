//! The pages: whole in one file, well formed, with every picture drawn.

use roxmltree::{Document, Node};

use super::{QUICK, VERDICTS};

/// Asserts that a page is one well-formed file that fetches nothing; returns the number of pictures.
pub fn is_whole(page: &str) -> usize {
    let body = page.strip_prefix("<!DOCTYPE html>\n").unwrap();
    let document = Document::parse(body).unwrap();
    let elements = || document.descendants().filter(Node::is_element);
    for node in elements() {
        let name = node.tag_name().name();
        assert!(!["script", "link", "img", "iframe", "object"].contains(&name), "{name}");
        for attribute in node.attributes() {
            let value = attribute.value();
            let inside = value.starts_with('#') || value == "http://www.w3.org/2000/svg";
            let fetches = ["src", "href", "data", "srcset"].contains(&attribute.name());
            assert!(inside || !fetches, "{name} {}={value}", attribute.name());
        }
        if let Some(target) = node.attribute("href").and_then(|href| href.strip_prefix('#')) {
            assert!(elements().any(|other| other.attribute("id") == Some(target)), "{target}");
        }
    }
    for address in ["http:", "https:", "url(", "@import"] {
        let found = page
            .match_indices(address)
            .filter(|(at, _)| !page[*at..].starts_with("http://www.w3.org/"));
        assert_eq!(found.count(), 0, "{address}");
    }
    let pictures: Vec<_> = elements()
        .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "svg")))
        .collect();
    for picture in &pictures {
        assert!(picture.attribute("viewBox").is_some());
        let drawn = picture.descendants().filter(Node::is_element).count();
        assert!(drawn > 8, "an empty picture");
        assert!(picture.parent().unwrap().has_tag_name("figure"));
    }
    let ids: Vec<_> = elements().filter_map(|node| node.attribute("id")).collect();
    assert!(ids.iter().all(|id| ids.iter().filter(|other| *other == id).count() == 1));
    pictures.len()
}

#[test]
#[ignore = "long: ./check --full"]
fn the_page_is_whole_and_has_every_item_with_its_verdict() {
    let page = &QUICK.page;
    assert!(is_whole(page) >= 30);
    assert!(!page.contains("NaN") && !page.contains("inf "), "a number is none");
    let body = page.strip_prefix("<!DOCTYPE html>\n").unwrap();
    let document = Document::parse(body).unwrap();
    let sections = document.descendants().filter(|node| node.has_tag_name("section"));
    let with_ids: Vec<_> = sections.filter(|node| node.attribute("id").is_some()).collect();
    assert!(with_ids.len() >= 56);
    for section in with_ids {
        let badge = section.descendants().find(|node| node.has_tag_name("span")).unwrap();
        let word = badge.text().unwrap();
        assert!(VERDICTS.contains(&word.replace(' ', "_").as_str()), "{word}");
    }
    assert!(page.contains("prefers-color-scheme: dark") && page.contains("@media print"));
}
