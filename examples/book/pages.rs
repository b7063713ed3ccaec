//! The pages of the book, as Markdown for mdBook. They lie as the documents lie in the project, so that links between
//! documents hold.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use trackbed::check::{Entry, Folder, LIBRARY, library};
use trackbed::diag::Code;
use trackbed::schema::{self, Form, KINDS, Kind, Role};
use trackbed::{compile, report};

/// A line of the table of contents.
enum Line {
    /// A heading between pages.
    Part(&'static str),
    /// A page with its depth, its title and its place in the book.
    Page(usize, String, String),
}

/// Documents of each part, in the order in which they are read; those that are not listed here follow under the last
/// part.
const GUIDE: [&str; 8] = ["tutorial", "language", "report", "files", "mitigations", "grains", "editor", "shell"];
const EVIDENCE: [&str; 5] = ["validation", "statements", "readings", "faults", "soak"];

/// Writes the sources of the book into a folder, and gives the number of its pages.
pub fn write(root: &Path, folder: &Path) -> io::Result<usize> {
    let src = folder.join("src");
    if src.exists() {
        fs::remove_dir_all(&src)?;
    }
    fs::create_dir_all(&src)?;
    fs::write(folder.join("book.toml"), SETTINGS)?;
    let mut book = Book { root, src, lines: Vec::new() };
    book.all()?;
    let pages = book.lines.iter().filter(|line| matches!(line, Line::Page(..))).count();
    book.put("SUMMARY.md", &book.summary())?;
    Ok(pages)
}

const SETTINGS: &str = "[book]
title = \"Trackbed\"
language = \"en\"
src = \"src\"

[build]
build-dir = \"html\"
create-missing = false

[output.html]
default-theme = \"light\"
smart-punctuation = false

[output.html.search]
limit-results = 40
use-boolean-and = true
boost-title = 3
";

struct Book<'a> {
    root: &'a Path,
    src: PathBuf,
    lines: Vec<Line>,
}

impl Book<'_> {
    fn all(&mut self) -> io::Result<()> {
        self.document(0, "README.md")?;
        self.lines.push(Line::Part("Guide"));
        for name in GUIDE {
            self.document(0, &format!("docs/{name}.md"))?;
        }
        self.lines.push(Line::Part("Cookbook"));
        self.folder("docs/cookbook")?;
        self.lines.push(Line::Part("Scenes"));
        self.scenes()?;
        self.lines.push(Line::Part("Reference"));
        self.document(0, "docs/reference.md")?;
        self.kinds()?;
        self.modules()?;
        self.codes()?;
        self.lines.push(Line::Part("Evidence"));
        for name in EVIDENCE {
            self.document(0, &format!("docs/{name}.md"))?;
        }
        self.lines.push(Line::Part("The project"));
        self.folder("docs")?;
        self.document(0, "ARCHITECTURE.md")?;
        self.document(0, "CHANGELOG.md")?;
        for data in ["docs/charts", "docs/pictures", "docs/cookbook", "scenarios", "scenarios/cookbook"] {
            self.copy_data(data)?;
        }
        for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
            self.put(file, &fs::read_to_string(self.root.join(file))?)?;
        }
        Ok(())
    }

    fn put(&self, name: &str, text: &str) -> io::Result<()> {
        let path = self.src.join(name);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::write(path, text)
    }

    fn page(&mut self, depth: usize, title: &str, name: &str, text: &str) -> io::Result<()> {
        self.lines.push(Line::Page(depth, title.into(), name.into()));
        self.put(name, text)
    }

    /// A document of the project, under its first heading.
    fn document(&mut self, depth: usize, name: &str) -> io::Result<()> {
        let place = in_the_book_as(name);
        let has = |line: &Line| matches!(line, Line::Page(_, _, known) if *known == place);
        if self.lines.iter().any(has) {
            return Ok(());
        }
        let text = fs::read_to_string(self.root.join(name))?;
        let title = text.lines().find_map(|line| line.strip_prefix("# ")).unwrap_or(name).replace('`', "");
        self.page(depth, &title, &place, &with_links_to_the_book(&text))
    }

    /// The documents of a folder that have no place yet; its `README.md` first, the others below it.
    fn folder(&mut self, folder: &str) -> io::Result<()> {
        let mut names = files(&self.root.join(folder), "md")?;
        let start = names.iter().position(|name| name == "README.md").map(|at| names.remove(at));
        if let Some(name) = &start {
            self.document(0, &format!("{folder}/{name}"))?;
        }
        for name in names {
            self.document(usize::from(start.is_some()), &format!("{folder}/{name}"))?;
        }
        Ok(())
    }

    /// Files beside documents, to which they link.
    fn copy_data(&self, folder: &str) -> io::Result<()> {
        for entry in fs::read_dir(self.root.join(folder))? {
            let path = entry?.path();
            if path.is_file() && path.extension().is_none_or(|e| e != "md") {
                let name = path.file_name().unwrap_or_default();
                let to = self.src.join(folder).join(name);
                to.parent().map_or(Ok(()), fs::create_dir_all)?;
                fs::copy(&path, to)?;
            }
        }
        Ok(())
    }

    /// Every shipped scene: what its first comment says, its picture and its text.
    fn scenes(&mut self) -> io::Result<()> {
        for name in files(&self.root.join("scenarios"), "track")? {
            let text = fs::read_to_string(self.root.join("scenarios").join(&name))?;
            let stem = name.trim_end_matches(".track").to_string();
            let page = self.scene(&stem, &text)?;
            self.page(0, &stem, &format!("scenarios/{stem}.md"), &page)?;
        }
        Ok(())
    }

    fn scene(&self, stem: &str, text: &str) -> io::Result<String> {
        let compiled = compile(&format!("{stem}.track"), text, &Folder(self.root.join("scenarios")), &[]);
        let about: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//")).map(str::trim).collect();
        let command = if compiled.studies.is_empty() { "run" } else { "study" };
        let mut page = format!("# {stem}\n\n{}\n\n", about.join("\n"));
        if let Some(scenario) = &compiled.scenario {
            self.put(&format!("scenarios/{stem}.svg"), &report::drawing_svg(scenario))?;
            page += &format!("![The scene to scale]({stem}.svg)\n\n");
        }
        page += &format!(
            "```sh\ntrackbed {command} scenarios/{stem}.track --out out\n```\n\n[The file]({stem}.track):\n\n"
        );
        Ok(page + &format!("```text\n{text}```\n"))
    }

    /// Every kind of the language.
    fn kinds(&mut self) -> io::Result<()> {
        for (title, name, nested) in
            [("Declarations", "declarations", false), ("Values inside declarations", "values", true)]
        {
            let kinds: Vec<&Kind> = KINDS.iter().filter(|kind| (kind.role == Role::Nested) == nested).collect();
            let list: String =
                kinds.iter().map(|kind| format!("- [`{0}`]({0}.md): {1}\n", kind.name, kind.doc)).collect();
            self.page(0, title, &format!("reference/{name}.md"), &format!("# {title}\n\n{list}"))?;
            for kind in kinds {
                self.page(1, kind.name, &format!("reference/{}.md", kind.name), &kind_page(kind))?;
            }
        }
        Ok(())
    }

    /// Every module of the standard library.
    fn modules(&mut self) -> io::Result<()> {
        let list: String = LIBRARY.iter().map(|(module, _)| format!("- [`{module}`]({module}.md)\n")).collect();
        self.page(
            0,
            "Standard library",
            "library/index.md",
            &format!("# Standard library\n\n{LIBRARY_USE}\n\n{list}"),
        )?;
        let entries = library();
        for (module, _) in LIBRARY {
            let own = entries.iter().filter(|entry| entry.module == *module);
            let page: String = own.map(entry_section).collect();
            self.page(1, module, &format!("library/{module}.md"), &format!("# {module}\n\n{page}"))?;
        }
        Ok(())
    }

    /// Every code, physics rules apart.
    fn codes(&mut self) -> io::Result<()> {
        for (title, name, is_rule) in [("Physics rules", "rules", true), ("Codes", "codes", false)] {
            let codes: Vec<Code> = Code::ALL.iter().copied().filter(|code| code.rule().is_some() == is_rule).collect();
            let named = |code: &Code| code.rule().map_or(String::new(), |rule| format!(" `{rule}`"));
            let line = |code: &Code| format!("- [{code}](../explain/{code}.md){}: {}\n", named(code), code.title());
            let list: String = codes.iter().map(line).collect();
            self.page(0, title, &format!("reference/{name}.md"), &format!("# {title}\n\n{list}"))?;
            for code in codes {
                let title = format!("{code}{}", code.rule().map_or(String::new(), |rule| format!(" {rule}")));
                self.page(1, &title, &format!("explain/{code}.md"), code.page())?;
            }
        }
        Ok(())
    }

    fn summary(&self) -> String {
        let line = |line: &Line| match line {
            Line::Part(title) => format!("\n# {title}\n\n"),
            Line::Page(depth, title, name) => format!("{}- [{title}]({name})\n", "  ".repeat(*depth)),
        };
        format!("# Summary\n\n{}", self.lines.iter().map(line).collect::<String>())
    }
}

const LIBRARY_USE: &str = "`use std` brings in every module. `read` is taken over from its source, `derived` is computed from other \
                           data, `unchecked` is common knowledge.";

/// The section of a kind, with the kinds of its parts and the modules that hold entries.
fn kind_page(kind: &Kind) -> String {
    let section = schema::section(kind).replacen("### ", "# ", 1);
    let mut parts: Vec<&str> = kind.fields.iter().flat_map(|field| objects(&field.form)).collect();
    parts.sort_unstable();
    parts.dedup();
    let entries = library();
    let mut modules: Vec<&str> =
        entries.iter().filter(|entry| entry.kind == kind.name).map(|entry| entry.module).collect();
    modules.dedup();
    let listed = |names: &[&str], folder: &str| {
        names.iter().map(|name| format!("[`{name}`]({folder}{name}.md)")).collect::<Vec<_>>().join(", ")
    };
    let mut page = section;
    if !parts.is_empty() {
        page += &format!("\nParts: {}.\n", listed(&parts, ""));
    }
    if !modules.is_empty() {
        page += &format!("\nStandard library: {}.\n", listed(&modules, "../library/"));
    }
    page
}

/// The kinds of the objects that may stand in a form.
fn objects(form: &Form) -> Vec<&'static str> {
    match form {
        Form::Object(kind) => vec![kind],
        Form::OneOf(forms) => forms.iter().flat_map(objects).collect(),
        Form::List(item) => objects(item),
        Form::Pairs { key, value, .. } => [objects(key), objects(value)].concat(),
        _ => Vec::new(),
    }
}

fn entry_section(entry: &Entry) -> String {
    let base = entry.base.as_ref().map_or(String::new(), |base| format!("\nIt extends `{base}`.\n"));
    let row = |(path, value): &(String, String)| {
        format!("| `{path}` | `{}` |\n", value.replace('|', "\\|").replace('\n', " "))
    };
    let rows: String = entry.fields.iter().map(row).collect();
    format!(
        "## {0}.{1}\n\n{2}\n{base}\n[`{3}`](../reference/{3}.md) | value\n---|---\n{rows}\nEvidence: {4}. Source: {5}.\n\n",
        entry.module, entry.name, entry.doc, entry.kind, entry.evidence, entry.source
    )
}

/// Links to shipped scenes lead to their pages, and those to files of the program stay text.
fn with_links_to_the_book(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("](") {
        let Some(length) = rest[at..].find(')') else { break };
        let (before, target) = (&rest[..at], &rest[at + 2..at + length]);
        match in_the_book(target) {
            true => out += &format!("{before}]({})", in_the_book_as(target)),
            false => match before.rfind('[') {
                Some(open) => out += &format!("{}{}", &before[..open], &before[open + 1..]),
                None => out += before,
            },
        }
        rest = &rest[at + length + 1..];
    }
    out + rest
}

/// The place of a document in the book: `README.md` is the first page of its folder.
fn in_the_book_as(document: &str) -> String {
    document.replace("README.md", "index.md")
}

/// Whether the target of a link is a page or a file of the book.
fn in_the_book(target: &str) -> bool {
    let inside = target.trim_start_matches("../");
    let outside = ["src/", "tests/", "examples/", "benches/", "fuzz/", "editors/", "stdlib/", "grammar/"];
    !outside.iter().any(|folder| inside.starts_with(folder))
}

/// The names of the files of a folder with that extension, sorted.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == extension) {
            names.extend(path.file_name().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}
