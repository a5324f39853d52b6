//! Tables that a reader can sort.

use super::page::escape;

/// A table. Clicking a heading sorts it, where the page may run its script.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// Caption above it; none where it is empty.
    pub caption: String,
    /// Headings and kinds of the columns, left to right.
    pub columns: Vec<Column>,
    /// The rows, in their initial order.
    pub rows: Vec<Row>,
}

/// What is common to the cells of a column.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Column {
    /// Heading as plain text.
    pub heading: String,
    /// What it means: the tooltip of the heading.
    pub explanation: String,
    /// Unit of its numbers; empty where they have none, or the cells contain it.
    pub unit: String,
    /// Whether it holds numbers, which are aligned to the right.
    pub is_number: bool,
}

impl Column {
    /// A column of words.
    pub fn words(heading: &str, explanation: &str) -> Self {
        Self { heading: heading.into(), explanation: explanation.into(), unit: String::new(), is_number: false }
    }

    /// A column of numbers.
    pub fn numbers(heading: &str, unit: &str, explanation: &str) -> Self {
        Self { is_number: true, unit: unit.into(), ..Self::words(heading, explanation) }
    }
}

/// A row, with what its HTML says of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    /// One per column; missing ones are empty.
    pub cells: Vec<Cell>,
    /// Whether it is highlighted.
    pub is_marked: bool,
    /// Whether it is greyed out: for what was not measured.
    pub is_muted: bool,
    /// Its `id`, if it has one.
    pub id: Option<String>,
    /// Its `data-*` attributes, by names that HTML allows.
    pub data: Vec<(String, String)>,
}

impl Row {
    /// A row that is neither highlighted nor greyed out.
    pub fn of(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }
}

/// A cell: its HTML, and the number it is sorted by.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cell {
    /// Content, already escaped.
    html: String,
    /// The number it is sorted by. Without one it is sorted by its text, or in a column of numbers comes last.
    value: Option<f64>,
}

impl Cell {
    /// A cell of plain text, which is escaped.
    pub fn text(text: &str) -> Self {
        Self { html: escape(text), value: None }
    }

    /// A number as it is shown.
    pub fn number(shown: &str, value: f64) -> Self {
        Self { html: escape(shown), value: Some(value).filter(|value| value.is_finite()) }
    }

    /// HTML, with the number it is sorted by, if there is one.
    pub fn html(html: String, value: Option<f64>) -> Self {
        Self { html, value: value.filter(|value| value.is_finite()) }
    }

    /// A cell without text or number.
    pub fn empty() -> Self {
        Self::default()
    }
}

impl Table {
    /// The table as HTML.
    pub fn html(&self) -> String {
        let caption = match self.caption.as_str() {
            "" => String::new(),
            text => format!("<caption>{}</caption>\n", escape(text)),
        };
        let headings: String = self.columns.iter().map(heading).collect();
        let rows: String = self.rows.iter().map(|row| self.row(row)).collect();
        format!(
            "<div class=\"scroll\"><table class=\"sortable\">\n{caption}<thead><tr>{headings}</tr></thead>\n\
             <tbody>\n{rows}</tbody></table></div>\n"
        )
    }

    fn row(&self, row: &Row) -> String {
        let classes = [(row.is_marked, "marked"), (row.is_muted, "muted")];
        let classes: Vec<&str> = classes.iter().filter(|(is_so, _)| *is_so).map(|(_, name)| *name).collect();
        let mut attributes = attribute("class", &classes.join(" "));
        attributes += &attribute("id", row.id.as_deref().unwrap_or_default());
        for (name, value) in &row.data {
            attributes += &format!(" data-{name}=\"{}\"", escape(value));
        }
        let nothing = Cell::empty();
        let cells = self.columns.iter().enumerate();
        let cells: String = cells.map(|(k, column)| cell(row.cells.get(k).unwrap_or(&nothing), column)).collect();
        format!("<tr{attributes}>{cells}</tr>\n")
    }
}

fn heading(column: &Column) -> String {
    let class = if column.is_number { " class=\"number\"" } else { "" };
    let title = attribute("title", &column.explanation);
    let unit = match column.unit.as_str() {
        "" => String::new(),
        unit => format!(" <span class=\"unit\">{}</span>", escape(unit)),
    };
    format!("<th scope=\"col\"{class}{title}>{}{unit}</th>", escape(&column.heading))
}

fn cell(cell: &Cell, column: &Column) -> String {
    let class = if column.is_number { " class=\"number\"" } else { "" };
    let value = cell.value.map_or(String::new(), |value| format!(" data-value=\"{value}\""));
    format!("<td{class}{value}>{}</td>", cell.html)
}

/// An attribute, unless it is empty.
fn attribute(name: &str, value: &str) -> String {
    if value.is_empty() { String::new() } else { format!(" {name}=\"{}\"", escape(value)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_hold_what_they_show_and_what_they_are_sorted_by() {
        let table = Table {
            caption: "A & B".into(),
            columns: vec![Column::words("name", ""), Column::numbers("time", "s", "by the \"clock\"")],
            rows: vec![
                Row {
                    is_marked: true,
                    id: Some("a".into()),
                    data: vec![("kind".into(), "<x>".into())],
                    ..Row::default()
                },
                Row::of(vec![Cell::text("<b>"), Cell::number("1.5", 1.5)]),
                Row::of(vec![Cell::text("c"), Cell::number("?", f64::NAN)]),
            ],
        };
        let html = table.html();
        for part in [
            "<caption>A &amp; B</caption>",
            "<th scope=\"col\" class=\"number\" title=\"by the &quot;clock&quot;\">\
             time <span class=\"unit\">s</span></th>",
            "<tr class=\"marked\" id=\"a\" data-kind=\"&lt;x&gt;\"><td></td><td class=\"number\"></td></tr>",
            "<td>&lt;b&gt;</td><td class=\"number\" data-value=\"1.5\">1.5</td>",
            "<td class=\"number\">?</td>",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
    }
}
