//! The images of an array in a browser.

use serde_json::Value;

use super::common::Server;
use super::common::chromium::{Chromium, pictures};

const FACTS: &str = "document.getElementById('pixel-facts').innerText";
const PAINTED: &str = "document.getElementById('picture').width === 30 && document.getElementById('picture').height === 40";

/// Returns the value that the page lists for the pixel.
fn fact(browser: &mut Chromium, name: &str) -> String {
    let value = browser.value(&format!(
        "[...document.querySelectorAll('#pixel-facts dt')].find(dt => dt.textContent === '{name}').nextSibling.textContent"
    ));
    value.as_str().unwrap().to_owned()
}

/// Selects a pixel by the fields.
fn select(browser: &mut Chromium, row: usize, column: usize) {
    for (id, value) in [("pixel-row", row), ("pixel-column", column)] {
        browser.value(&format!(
            "(() => {{ const e = document.getElementById('{id}'); e.value = {value}; e.dispatchEvent(new Event('change')); }})()"
        ));
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn the_image_and_the_values_of_its_pixels_appear() {
    let server = Server::start(&["--stopped", "array"]);
    server.act("run", "{\"frames\":2}");
    let image = server.get("image").json();
    let mut browser = Chromium::open(&server.url, (1280, 900), "light");
    browser.wait(&format!("{PAINTED} && {FACTS}.includes('depth')"));
    for hidden in ["histogram", "ila-arm", "shot-draw", "laser_en", "strip", "timeline"] {
        let shown =
            browser.value(&format!("document.getElementById('{hidden}').checkVisibility()"));
        assert_eq!(shown, false, "{hidden}");
    }
    let place = 10 * 30 + 7;
    select(&mut browser, 10, 7);
    let number = |name: &str| image[name][place].as_f64().unwrap();
    assert_eq!(fact(&mut browser, "depth"), format!("{:.4} m", number("depth_m")));
    assert_eq!(fact(&mut browser, "sigma"), format!("{:.2} mm", 1e3 * number("sigma_m")));
    assert_eq!(fact(&mut browser, "true depth"), format!("{:.4} m", number("true_m")));
    assert_eq!(
        fact(&mut browser, "expected signal"),
        with_commas(&format!("{:.1} hits", number("signal_hits")))
    );
    let rejected =
        image["valid"].as_array().unwrap().iter().position(|valid| valid == false).unwrap();
    select(&mut browser, rejected / 30, rejected % 30);
    let words: Vec<_> = image["status"][rejected]
        .as_array()
        .unwrap()
        .iter()
        .map(|word| word.as_str().unwrap())
        .collect();
    assert_eq!(fact(&mut browser, "status"), format!("rejected: {}", words.join(", ")));
    let colour = |browser: &mut Chromium, place: usize| {
        browser.value(&format!(
            "[...document.getElementById('picture').getContext('2d').getImageData({}, {}, 1, 1).data].join()",
            place % 30,
            place / 30
        ))
    };
    assert_eq!(colour(&mut browser, rejected), "225,225,225,255");
    // The nearest is dark, the farthest light.
    let valid = (0..1200).filter(|&place| image["valid"][place] == true);
    let depth = |place: &usize| image["depth_m"][*place].as_f64().unwrap();
    let nearest = valid.clone().min_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap();
    let farthest = valid.max_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap();
    assert_eq!(colour(&mut browser, nearest), "68,1,84,255");
    assert_eq!(colour(&mut browser, farthest), "254,232,37,255");

    // By the keyboard: the pixel to the right of the first one.
    select(&mut browser, 0, 0);
    browser.value("document.getElementById('pixels').focus()");
    browser.value(
        "document.getElementById('pixels').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }))",
    );
    browser.wait(
        "document.getElementById('pixel-words').textContent.startsWith('Row 0, column 1: depth')",
    );
    // By the pointer: it hovers over the last one.
    browser.value(
        "(() => { const at = document.getElementById('picture').getBoundingClientRect(); \
         document.getElementById('pixels').dispatchEvent(new PointerEvent('pointermove', { pointerType: 'mouse', clientX: at.right - 1, clientY: at.bottom - 1 })); })()",
    );
    assert_eq!(fact(&mut browser, "hits"), with_commas(&image["hits"][1199].to_string()));
    browser.value("document.activeElement.blur()");
    browser.press("h");
    browser.wait("document.getElementById('picture').getAttribute('aria-label').startsWith('Hits in the histogram, image 1')");
    browser.press("n");
    browser.wait("document.getElementById('image-facts').textContent.startsWith('Image 2: ')");
    browser.value(
        "(() => { const slider = document.getElementById('slider-target.distance_m'); \
         slider.value = 0.3; slider.dispatchEvent(new Event('input')); })()",
    );
    browser.wait("document.getElementById('scene-hint').textContent === 'The next image is of the new scene.'");
    browser.press(" ");
    browser.wait("document.getElementById('scene-hint').textContent === ''");
    browser.wait("Number(document.getElementById('images-done').textContent) > 1");
    assert_eq!(browser.complaints, Vec::<String>::new());
}

/// Separates the thousands of a number below a million.
fn with_commas(number: &str) -> String {
    let whole = number.find(|c: char| !c.is_ascii_digit()).unwrap_or(number.len());
    if whole < 4 {
        return number.to_owned();
    }
    let (thousands, rest) = number.split_at(whole - 3);
    format!("{thousands},{rest}")
}

#[test]
#[ignore = "long: ./check --full"]
fn the_page_of_an_array_fits_a_phone_and_a_wide_screen_in_the_light_and_in_the_dark() {
    let server = Server::start(&["--stopped", "array"]);
    server.act("run", "{\"frames\":1}");
    for (width, scheme) in [(400, "light"), (400, "dark"), (1280, "light"), (1280, "dark")] {
        let mut browser = Chromium::open(&server.url, (width, 900), scheme);
        browser.wait(&format!("{PAINTED} && {FACTS}.includes('depth')"));
        let wide = browser.value("document.documentElement.scrollWidth");
        let over = browser.value(
            "[...document.querySelectorAll('body *')].filter(e => !e.closest('.unseen, .skip, pre, svg, .scroll') && \
             e.getBoundingClientRect().right > innerWidth + 1).map(e => e.tagName + '#' + e.id)",
        );
        if let Some(folder) = pictures() {
            for (key, quantity) in [("h", "hits"), ("s", "sigma"), ("d", "depth")] {
                browser.press(key);
                browser.wait(&format!("document.getElementById('show-{quantity}').checked"));
                let name = format!("array-{width}-{scheme}-{quantity}.png");
                browser.screenshot(&folder.join(name));
            }
        }
        assert_eq!((wide.as_u64(), over), (Some(u64::from(width)), Value::Array(vec![])));
        let unnamed = browser.value(
            "[...document.querySelectorAll('button, input, select, textarea, a, canvas')].filter(e => e.checkVisibility() && \
             !(e.textContent.trim() || e.labels?.length || e.getAttribute('aria-label'))).map(e => e.outerHTML)",
        );
        assert_eq!(unnamed, Value::Array(vec![]));
        assert_eq!(browser.complaints, Vec::<String>::new());
    }
}
