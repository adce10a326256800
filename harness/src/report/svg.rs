//! A small writer of SVG.

use std::fmt::Write;

/// A drawing; lengths are in pixels, y points down.
pub struct Svg {
    size: [f64; 2],
    body: String,
}

/// Where a text stands at its place.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// How a line looks.
#[derive(Clone, Copy)]
pub struct Stroke {
    /// Colour.
    pub colour: &'static str,
    /// Width.
    pub width: f64,
    /// Dashes and gaps; empty for a whole line.
    pub dash: &'static str,
}

impl Svg {
    /// An empty drawing of this size.
    pub fn new(size: [f64; 2]) -> Self {
        Self {
            size,
            body: String::new(),
        }
    }

    /// A line through places.
    pub fn line(&mut self, places: &[[f64; 2]], stroke: Stroke) {
        let points: Vec<String> = places
            .iter()
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        let dash = match stroke.dash {
            "" => String::new(),
            dash => format!(" stroke-dasharray=\"{dash}\""),
        };
        let Stroke { colour, width, .. } = stroke;
        self.add(format_args!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{dash}/>",
            points.join(" ")
        ));
    }

    /// A closed shape, filled.
    pub fn shape(&mut self, places: &[[f64; 2]], colour: &str) {
        let points: Vec<String> = places
            .iter()
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        self.add(format_args!(
            "<polygon points=\"{}\" fill=\"{colour}\"/>",
            points.join(" ")
        ));
    }

    /// A disc.
    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, colour: &str) {
        self.add(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>"
        ));
    }

    /// A text; `turned` by a quarter to the left or not.
    pub fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor, turned: bool) {
        let turn = match turned {
            true => format!(" transform=\"rotate(-90 {x:.1} {y:.1})\""),
            false => String::new(),
        };
        self.add(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{}\" \
             dominant-baseline=\"middle\"{turn}>{}</text>",
            anchor.name(),
            escape(text)
        ));
    }

    fn add(&mut self, element: std::fmt::Arguments<'_>) {
        // A String takes all that is written to it.
        let _ = writeln!(self.body, "{element}");
    }

    /// The drawing as an element that fits the width of a page; `title` is what readers of screens say.
    pub fn finish(self, title: &str) -> String {
        let [width, height] = self.size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
             font-family=\"sans-serif\" fill=\"#222\">\n<title>{}</title>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// Text that means itself in HTML, SVG and their attributes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            c => escaped.push(c),
        }
    }
    escaped
}
