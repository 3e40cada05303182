//! The examples of scenes in a page of documentation: the first one is the head that the others continue.

/// The blocks of TOML in a page.
pub fn blocks(page: &str) -> Vec<&str> {
    page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// An example as a whole scene: below the head, except for the tables that the example contains itself.
pub fn below_head(head: &str, example: &str) -> String {
    let tables = head.split("\n\n").filter(|table| {
        let name = table.lines().next().unwrap_or_default().trim_matches(['[', ']']);
        !example.contains(&format!("[{name}]"))
    });
    format!("{}\n{example}", tables.collect::<Vec<_>>().join("\n\n"))
}
