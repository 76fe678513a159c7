# SPDX-License-Identifier: MIT
"""Whether a folder holds a sound page: index.html is well-formed and complete in itself,
every picture is a PNG of the size that the page says."""
import html.parser
import json
import os
import struct

VOID = {"meta", "link", "img", "br", "hr", "input", "wbr"}
# Elements that may not hold these: what an HTML parser would silently close early.
NOT_IN_P = {"div", "p", "table", "figure", "ul", "ol", "section", "details", "h1", "h2", "h3"}


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open = []
        self.faults = []
        self.ids = set()
        self.links = []
        self.pictures = []
        self.tags = {}

    def fault(self, text):
        self.faults.append(f"line {self.getpos()[0]}: {text}")

    def handle_starttag(self, tag, attributes):
        self.start(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        if "svg" not in self.open and tag not in VOID:
            self.fault(f"<{tag}/> outside SVG")
        self.start(tag, attributes)

    def start(self, tag, attributes):
        names = [name for name, _ in attributes]
        values = dict(attributes)
        self.tags[tag] = self.tags.get(tag, 0) + 1
        if len(set(names)) < len(names):
            self.fault(f"<{tag}> has an attribute twice")
        if tag in NOT_IN_P and "p" in self.open:
            self.fault(f"<{tag}> inside <p>")
        if tag in ("script", "iframe", "object", "embed"):
            self.fault(f"<{tag}>")
        if "id" in values:
            if values["id"] in self.ids:
                self.fault(f"id {values['id']} twice")
            self.ids.add(values["id"])
        for name, value in attributes:
            value = value or ""
            if name in ("src", "href", "srcset", "data", "poster"):
                self.links.append((tag, value))
            if "http:" in value.replace("http://www.w3.org/2000/svg", "") \
                    or "https:" in value:
                self.fault(f"<{tag} {name}> leaves the folder: {value}")
            if name.startswith("on"):
                self.fault(f"<{tag} {name}> is a script")
        if tag == "img":
            for name in ("src", "alt", "width", "height"):
                if not values.get(name):
                    self.fault(f"<img> without {name}")
            if values.get("loading") != "lazy" or "a" not in self.open:
                self.fault("<img> is not lazy, or links to nothing")
            self.pictures.append(values)

    def handle_endtag(self, tag):
        if not self.open or self.open[-1] != tag:
            self.fault(f"</{tag}> closes {self.open[-1:]}")
        else:
            self.open.pop()


def size_of_png(path):
    with open(path, "rb") as file:
        head = file.read(26)
    if head[:8] != b"\x89PNG\r\n\x1a\n" or head[12:16] != b"IHDR":
        return None
    return struct.unpack(">II", head[16:24])


def check_links(folder, page):
    for _, link in page.links:
        if link.startswith("data:"):
            continue
        if link.startswith("#"):
            if link[1:] not in page.ids:
                page.faults.append(f"{link} leads nowhere")
        elif not os.path.isfile(os.path.join(folder, link)):
            page.faults.append(f"{link} is not there")
    named = set()
    for picture in page.pictures:
        path = os.path.join(folder, picture["src"])
        named.add(picture["src"])
        size = size_of_png(path) if os.path.isfile(path) else None
        if size != (int(picture["width"]), int(picture["height"])):
            page.faults.append(f"{picture['src']}: is {size}, not as the page says")
    if len(named) < len(page.pictures):
        page.faults.append("a picture is shown twice under one name")


def faults_of(folder):
    """What is wrong with the page in a folder, as texts."""
    page = Page()
    with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
        text = file.read()
    page.feed(text)
    page.close()
    if page.open:
        page.faults.append(f"never closed: {page.open}")
    if not text.startswith("<!DOCTYPE html>\n"):
        page.faults.append("no doctype")
    if {"nan", "inf"} & set(text.lower().split()):
        page.faults.append("a NaN on the page")
    if "url(http" in text or "@import" in text:
        page.faults.append("the style sheet leaves the folder")
    if page.tags.get("h1") != 1 or page.tags.get("title") != 1:
        page.faults.append("no title, or several")
    check_links(folder, page)
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        results = json.load(file, parse_constant=page.faults.append)
    if "version" not in results or "views" not in results:
        page.faults.append("report.json lacks version or views")
    if not page.pictures:
        page.faults.append("no picture")
    return page.faults
