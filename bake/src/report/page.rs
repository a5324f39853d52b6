//! One HTML document that needs no network; its content security policy forbids any.

/// The style of every report.
const STYLE: &str = include_str!("page.css");
/// The script of every report: sorting tables.
const SCRIPT: &str = include_str!("sort.js");

/// An HTML document. `title` is text; `style`, `body` and `script` are CSS, HTML and JavaScript, put after those of
/// all reports and used as they are: text from elsewhere must go through [`escape`].
pub fn page(title: &str, style: &str, body: &str, script: &str) -> String {
    let title = escape(title);
    format!(
        r#"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
    content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{STYLE}{style}</style>
</head>
<body>
{body}
<script>
{SCRIPT}{script}</script>
</body>
</html>
"#
    )
}

/// Text as HTML, also valid within an attribute in either kind of quotes. Characters that HTML does not allow become
/// spaces.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' | '\t' => escaped.push(c),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_text_wherever_it_is_put() {
        assert_eq!(escape("<a href=\"x\">'&'\u{0}"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39; ");
        assert_eq!(escape("Zürich, 東京"), "Zürich, 東京");
    }

    #[test]
    fn a_page_refuses_the_network_and_holds_what_it_is_given() {
        let page = page("<b>", ".x { color: red }", "<p>body</p>", "f();");
        for part in ["default-src 'none'", "utf-8", "<title>&lt;b&gt;</title>", ".x { color", "<p>body</p>", "f();"] {
            assert!(page.contains(part), "{part}");
        }
        assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("<link"));
    }
}
