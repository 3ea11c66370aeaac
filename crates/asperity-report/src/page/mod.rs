//! A results directory as one HTML page, made from what it holds and from nothing else.
//!
//! A section is HTML, which reads and prints by itself, and data, which the page's own programs draw: maps in
//! levels and curves, those of the figures. Nothing on the page asks for anything from outside.

mod answers;
mod bodies;
mod cards;
mod case;
mod contact;
mod course;
mod curves;
mod explorer;
mod plastic;
mod head;
mod html;
mod interface;
mod joint;
mod layers;
mod live;
mod numbers;
mod overview;
mod page_data;
mod quantised;
mod capability;
mod plane;
mod shown_body;
mod study;
mod subsurface;
mod table;
#[cfg(test)]
mod tests;
mod trust;
mod verdict;
mod witness;
mod words;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use asperity_base::Field;
use asperity_base::units::Metre;
use asperity_study::Results;
use asperity_study::io;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use crate::draw::{Colours, Paper, palette};
use crate::figures::{self, FigureOptions};
pub use joint::{joint_in_words, write_joint};
pub use live::LivePage;
use page_data::PageData;
use quantised::QuantisedField;
pub use study::{answers_of_study, write_study};
pub use verdict::layers_in_words;
use witness::{DPI, PICTURES};
pub use witness::{Seen, gathered};

/// Name of the page in a results directory.
pub const FILE: &str = "report.html";

/// Writes the page of the results in `directory`, finished or under way, to `out`, or into the directory, and
/// gives its path.
///
/// # Errors
/// [`asperity_base::Error::NoResults`] and [`asperity_base::Error::File`]; what else of the results cannot be
/// read is left out and named.
pub fn make(directory: &Path, out: Option<&Path>) -> asperity_base::Result<PathBuf> {
    let results = Results::open(directory)?;
    let path = out.map_or_else(|| path_of(&results), Path::to_owned);
    write(&results, &path)?;
    Ok(path)
}

/// The colours of maps by their kind, for the programs of a page.
pub fn colours() -> Value {
    json!({
        "heights": palette(Colours::Heights),
        "pressure": palette(Colours::Pressure),
        "diverging": palette(Colours::Signed),
    })
}

/// Heights as the programs of a page draw them.
pub fn map_of_heights(heights: &Field, pitch: [Metre; 2]) -> Value {
    json!(QuantisedField::even(heights, pitch))
}

/// Where the page of a results directory is.
pub fn path_of(results: &Results) -> PathBuf {
    results.directory().join(FILE)
}

/// Writes the page of `results` to `path`, and gives what could not be read and is not on it; where that
/// fails the one that is there stays.
pub fn write(results: &Results, path: &Path) -> asperity_base::Result<Vec<String>> {
    write_with(results, witness::parts(results), path)
}

/// [`write()`] with the parts of the page that have been made already.
pub fn write_with(results: &Results, seen: Option<Seen>, path: &Path) -> asperity_base::Result<Vec<String>> {
    let (page, missing) = page(results, seen)?;
    // What killed processes have left beside it.
    io::sweep(path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new(".")));
    io::replace(path, page.as_bytes())?;
    Ok(missing)
}

/// A section: its anchor, its title, its HTML.
type Section = (&'static str, &'static str, Option<String>);

/// The page, and what is missing on it.
fn page(results: &Results, seen: Option<Seen>) -> asperity_base::Result<(String, Vec<String>)> {
    let mut found = PageData::in_results(results, seen)?;
    let mut data = json!({ "colours": colours() });
    let mut charts = Vec::new();
    // What the case asks for comes first.
    let mut sections = capability::sections(&mut found, &mut data, &mut charts);
    let interface = interface::section(&found, &mut charts);
    let over_speed = ("speed", "Over speed", course::over_speed(&found, &mut charts));
    let loading = ("loading", "Loading", course::loading(&found, &mut charts));
    let running_in = ("running-in", "Running in", course::running_in(&mut found, &mut charts));
    let contact = ("contact", "Contact", contact::section(&mut found, &mut data, &mut charts));
    // Numbers of the interface without a curve come after the maps.
    let beginning = match figures::of_force_distance(&found.increments) {
        Some(_) => [interface, running_in, over_speed, loading, contact],
        None => [running_in, over_speed, loading, contact, interface],
    };
    sections.extend(beginning);
    sections.extend([
        ("below", "Below the surface", subsurface::section(&mut found, &mut data, &mut charts)),
        ("plastic", "Plastic flow", plastic::section(&mut found, &mut data, &mut charts)),
        ("bodies", "Bodies", bodies::section(&mut found, &mut data, &mut charts)),
        ("curves", "Curves", course::section(&mut found, &mut data, &mut charts)),
        ("trust", "Trust", Some(trust::section(&found))),
    ]);
    data["charts"] = charts.into();
    Ok((document(&found, &sections, &data), found.missing))
}

fn document(found: &PageData, sections: &[Section], data: &Value) -> String {
    let with_pictures = |(id, title, html): &Section| {
        let pictures = if *id == "contact" { pictures(found) } else { String::new() };
        (*id, *title, html.as_ref().map(|html| format!("{html}{pictures}")))
    };
    let sections: Vec<Section> = sections.iter().map(with_pictures).collect();
    framed(&head::title(found), &head::html(found), &sections, data)
}

/// A page of a title, what stands above all sections, those sections that there are, and the data for its
/// programs.
fn framed(title: &str, head: &str, sections: &[Section], data: &Value) -> String {
    let title = html::escaped(title);
    let there = || sections.iter().filter_map(|(id, title, html)| Some((id, title, html.as_ref()?)));
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{CHART_STYLE}\n{STYLE}</style>\n</head>\n<body>\n\
         <a class=\"skip\" href=\"#main\">to the results</a>\n<header class=\"bar\"><span class=\"name\">asperity</span>\
         <nav aria-label=\"sections\">"
    );
    for (id, title, _) in there() {
        let _ = write!(page, "<a href=\"#{id}\">{title}</a> ");
    }
    page += "</nav><button type=\"button\" id=\"theme\" hidden>dark</button></header>\n<main id=\"main\">\n";
    let _ = writeln!(page, "<section id=\"head\">{}</section>", head);
    for (id, title, html) in there() {
        let _ = write!(
            page,
            "<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>{html}"
        );
        page += "</section>\n";
    }
    let data = html::script_data(data);
    let _ = write!(
        page,
        "</main>\n<footer><p>Made by asperity {} from the results alone; it opens without a network.</p></footer>\n\
         <script type=\"application/json\" id=\"data\">{data}</script>\n<script>{CHARTS}</script>\n",
        env!("CARGO_PKG_VERSION")
    );
    for program in PROGRAMS {
        let _ = write!(page, "<script>\n{program}</script>\n");
    }
    page + "</body>\n</html>\n"
}

/// No request can leave the page.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";
/// uPlot 1.6.32, under the MIT licence that stands beside it.
const CHARTS: &str = concat!(
    "/*\n",
    include_str!("../../assets/report/LICENSE_UPLOT"),
    "*/\n",
    include_str!("../../assets/report/uPlot.iife.min.js")
);
const CHART_STYLE: &str = include_str!("../../assets/report/uPlot.min.css");
const STYLE: &str = include_str!("../../assets/report/page.css");
/// The page's own programs, each after what it uses.
const PROGRAMS: [&str; 9] = [
    include_str!("../../assets/report/data.js"),
    include_str!("../../assets/report/theme.js"),
    include_str!("../../assets/report/maps.js"),
    include_str!("../../assets/report/curves.js"),
    include_str!("../../assets/report/profile.js"),
    include_str!("../../assets/report/bodies.js"),
    include_str!("../../assets/report/scrubber.js"),
    include_str!("../../assets/report/study.js"),
    include_str!("../../assets/report/page.js"),
];

/// The maps as pictures, for who has no JavaScript.
fn pictures(found: &PageData) -> String {
    let drawn;
    let pictures = match found.pictures() {
        Some(pictures) => pictures,
        None => {
            let paper = Paper { dpi: DPI, ..Paper::default() };
            let only = PICTURES.map(str::to_owned).to_vec();
            let wanted = FigureOptions { paper, only, keep: false };
            // Unreadable files have been reported already.
            drawn = figures::pictures(found.results, &wanted).unwrap_or_default();
            &drawn
        }
    };
    let mut html = String::from("<noscript>");
    for (title, picture) in pictures {
        let _ = write!(
            html,
            "<img alt=\"{}\" src=\"data:image/png;base64,{}\">",
            html::escaped(title),
            STANDARD.encode(picture)
        );
    }
    html + "</noscript>"
}
