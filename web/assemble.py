"""The page from its parts: `python assemble.py MODULE DIST`.

MODULE is the folder with `asperity.js` and `asperity_bg.wasm` of `wasm-bindgen --target no-modules --out-name asperity`. DIST takes
`index.html`, `worker.js` and `asperity.bin`, the packed module, for a server, and `asperity.html`, one file with all of them, which opens by a double click.
"""

import base64
import re
import sys
import zlib
from pathlib import Path

WEB = Path(__file__).parent
REPORT = WEB.parent / "crates/asperity-report/assets/report"
# The programs of the page of results that the page draws with, each after what it uses.
SHARED = ["data.js", "theme.js", "maps.js", "curves.js", "profile.js"]
# Nothing leaves the page. A server is asked for the worker and the module, and for nothing else.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:; "
    "worker-src blob:; base-uri 'none'; form-action 'none'"
)
IMPORT = re.compile(r'^import \{[^}]*\} from "\./([\w-]+\.js)";\n', re.MULTILINE)


def bundled(main):
    """The modules from `main` on as one, each after those that it imports."""
    texts = {}

    def add(name):
        if name in texts:
            return
        source = (WEB / "src" / name).read_text()
        texts[name] = None
        for other in IMPORT.findall(source):
            add(other)
            assert texts[other] is not None, f"a circle of modules through {other}"
        del texts[name]
        texts[name] = re.sub(r"^export ", "", IMPORT.sub("", source), flags=re.MULTILINE)

    add(main)
    return "\n".join(texts.values())


def script(text, attributes=""):
    """An element; its text cannot end it."""
    assert "</script" not in text.lower()
    return f"<script{attributes}>\n{text}</script>\n"


def page(policy, more=""):
    """The HTML of the page; `more` are elements before its programs."""
    licence = f"/*\n{(REPORT / 'LICENSE_UPLOT').read_text()}*/\n"
    styles = [(REPORT / "uPlot.min.css").read_text(), (REPORT / "page.css").read_text(), (WEB / "page.css").read_text()]
    scripts = [script(licence + (REPORT / "uPlot.iife.min.js").read_text())]
    scripts += [script((REPORT / name).read_text()) for name in SHARED]
    scripts += [more, script(bundled("main.js"), ' type="module"')]
    parts = {"POLICY": policy, "STYLES": "\n".join(styles), "SCRIPTS": "".join(scripts)}
    return re.sub(r"@(POLICY|STYLES|SCRIPTS)@", lambda at: parts[at[1]], (WEB / "index.html").read_text())


def main(module, dist):
    worker = (module / "asperity.js").read_text() + "\n" + (WEB / "src/worker.js").read_text()
    wasm = (module / "asperity_bg.wasm").read_bytes()
    # Packed here, because plain hosts do not pack it.
    packed = zlib.compress(wasm, 9)
    text = base64.b64encode(packed).decode()
    inside = script(worker, ' type="text/plain" id="worker"') + f'<script type="text/plain" id="module">{text}</script>\n'
    dist.mkdir(parents=True, exist_ok=True)
    (dist / "index.html").write_text(page(POLICY + "; connect-src 'self'"))
    (dist / "worker.js").write_text(worker)
    (dist / "asperity.bin").write_bytes(packed)
    (dist / "asperity.html").write_text(page(POLICY, inside))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
