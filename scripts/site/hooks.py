"""What mkdocs does beside its own work for the site of the documents (mkdocs.yml).

The pages are written for GitHub: they link to files of the whole project, and have formulas in its dialect.
Here the pages of examples/ join the site, other files that are linked become pages with their text, formulas are
rendered by KaTeX, and a link without a goal, an anchor that its page lacks or a formula that does not parse
ends the build.
"""
import html
import html.parser
import json
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import urllib.parse

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
KATEX = pathlib.Path("/usr/share/javascript/katex")
LINK = re.compile(r"(\]\(\s*)([^)\s#]+)([^)\s]*\))")
FENCE = re.compile(r"^( *)(```+)(.*)$", re.MULTILINE)
LANGUAGES = {".hpp": "cpp", ".cpp": "cpp", ".h": "c", ".c": "c", ".py": "python", ".yaml": "yaml", ".xml": "xml"}


def outside_of_fences(text, change):
    """`text` with `change` made to what is not in a fenced block."""
    return "".join(piece if i % 2 else change(piece)
                   for i, piece in enumerate(re.split(r"(^ *```.*?^ *```\s*?$)", text, flags=re.M | re.S)))


def place(path):
    """Where the file `path` of the project is in the site, as the path of a source; None for what is not in it."""
    path = path.as_posix()
    if path.startswith("docs/"):
        return path[len("docs/"):]
    if path.startswith("examples/") and path.endswith(".md"):
        return path
    return f"source/{path}.md" if (ROOT / path).is_file() else None


def linked(target, page):
    """The file of the project that the link `target` of the file `page` means; None for an address."""
    if re.match(r"[a-z]+:", target):
        return None
    return pathlib.Path(os.path.relpath((page.parent / urllib.parse.unquote(target)).resolve(), ROOT))


def on_files(files, config):
    def add(uri, source):
        files.append(File(uri, ROOT, config.site_dir, config.use_directory_urls))
        files.get_file_from_path(uri).abs_src_path = str(source)

    for page in sorted((ROOT / "examples").glob("**/*.md")):
        add(page.relative_to(ROOT).as_posix(), page)
    for page in [file for file in files if file.is_documentation_page()]:
        source = pathlib.Path(page.abs_src_path)
        for _, target, _ in LINK.findall(source.read_text(encoding="utf-8")):
            path = linked(target, source)
            uri = path and place(path)
            if uri and uri.startswith("source/") and uri not in files:
                add(uri, ROOT / path)
    return files


def on_page_read_source(page, config):
    if not page.file.src_uri.startswith("source/"):
        return None
    path = pathlib.Path(page.file.abs_src_path)
    name = path.relative_to(ROOT).as_posix()
    text = path.read_text(encoding="utf-8")
    return f"# {name}\n\n````{LANGUAGES.get(path.suffix, 'text')}\n{text}\n````\n"


def on_page_markdown(markdown, page, config, files):
    source = pathlib.Path(page.file.abs_src_path)
    if page.file.src_uri.startswith("source/"):
        return markdown

    def here(match):
        path = linked(match[2], source)
        uri = path and place(path)
        if not uri:
            return match[0]
        return match[1] + posixpath.relpath(uri, posixpath.dirname(page.file.src_uri) or ".") + match[3]

    markdown = outside_of_fences(markdown, lambda text: LINK.sub(here, text))
    # Attributes that only the runner of the pages' commands reads.
    return FENCE.sub(lambda m: m[1] + m[2] + re.sub(r' (no-test|exit)="[^"]*"', "", m[3]), markdown)


class Formulas:
    """KaTeX in Node.js, which is started once."""

    def __init__(self):
        self.process = subprocess.Popen(["node", str(pathlib.Path(__file__).with_name("katex.cjs"))],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8")

    def render(self, tex, display, page):
        self.process.stdin.write(json.dumps({"tex": tex, "display": display}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if "error" in answer:
            raise PluginError(f"{page.file.src_uri}: formula {tex!r}: {answer['error']}")
        return answer["html"]

    def close(self):
        self.process.stdin.close()
        self.process.wait()


formulas = None


def on_post_page(output, page, config):
    global formulas
    formulas = formulas or Formulas()
    for pattern, display in ((r'<span class="arithmatex">\\\((.*?)\\\)</span>', False),
                             (r'<div class="arithmatex">\s*\\\[(.*?)\\\]\s*</div>', True)):
        output = re.sub(pattern, lambda m: formulas.render(html.unescape(m[1]), display, page), output, flags=re.S)
    return output


class Page(html.parser.HTMLParser):
    """The anchors of a page, and where it links to."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.add(attributes.get("id") or attributes.get("name"))
        for name in ("href", "src"):
            if attributes.get(name):
                self.links.append(attributes[name])


def on_post_build(config):
    global formulas
    if formulas:
        formulas.close()
        formulas = None
    site = pathlib.Path(config.site_dir)
    assets = site / "assets"
    shutil.copytree(KATEX / "fonts", assets / "katex/fonts", dirs_exist_ok=True)
    shutil.copy(KATEX / "katex.min.css", assets / "katex")
    shutil.copy(pathlib.Path(__file__).with_name("site.css"), assets)

    pages = {file: Page(file.read_text(encoding="utf-8")) for file in site.rglob("*.html") if file.name != "404.html"}
    wrong = []
    for file, page in pages.items():
        for link in page.links:
            address = urllib.parse.urlsplit(link)
            if address.scheme or address.netloc:
                continue
            goal = (file.parent / urllib.parse.unquote(address.path)).resolve() if address.path else file
            anchor = urllib.parse.unquote(address.fragment)
            if goal.is_dir():
                goal /= "index.html"
            if not goal.exists():
                wrong.append(f"{file.relative_to(site)}: {link}: no such file")
            elif anchor and goal in pages and anchor not in pages[goal].anchors:
                wrong.append(f"{file.relative_to(site)}: {link}: no such anchor")
    if wrong:
        raise PluginError("broken links:\n  " + "\n  ".join(sorted(set(wrong))))
