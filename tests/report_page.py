"""What stands on the page of a report."""

import json
from html.parser import HTMLParser
from pathlib import Path

VOID = {"meta", "img", "br", "link"}


class Page(HTMLParser):
    """What stands on a page, with a complaint about every element that is not closed."""

    def __init__(self, file):
        super().__init__()
        self.open, self.ids, self.links, self.tags = [], [], [], []
        self.data, self.texts, self.captions = [], [], []
        self.feed(Path(file).read_text(encoding="utf-8"))
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.tags.append((tag, given))
        if "id" in given:
            self.ids.append(given["id"])
        if tag == "a":
            self.links.append(given["href"])
        if tag not in VOID:
            self.open.append((tag, given))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if not self.open:
            return
        tag, given = self.open[-1]
        if given.get("type") == "application/json":
            self.data.append(json.loads(data))
        elif tag == "caption":
            self.captions.append(data.strip())
        elif tag not in ("script", "style") and data.strip():
            self.texts.append(" ".join(data.split()))

    @property
    def text(self):
        return "\n".join(self.texts)

    @property
    def figures(self):
        return self.data
