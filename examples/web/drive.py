#!/usr/bin/env python3
"""Uses the page in headless Chromium, over the WebDriver protocol, and compares its pictures with the library's.

    drive.py PICTURE [SCREENSHOT]    PICTURE: the program src/bin/picture.rs; SCREENSHOT: a file to write
"""

import base64
import functools
import hashlib
import http.server
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

HERE = pathlib.Path(__file__).parent
MOST_BYTES = 200_000
PATIENCE = 60
FLAGS = """--headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
    --disable-component-update --disable-sync --window-size=1280,900""".split()
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Browser:
    """A session of chromedriver."""

    def __init__(self):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        line = next(line for line in self.driver.stdout if "successfully" in line)
        threading.Thread(target=self.driver.stdout.read, daemon=True).start()
        self.root = "http://127.0.0.1:" + re.search(r"on port (\d+)", line)[1] + "/session"
        wanted = {"goog:chromeOptions": {"args": FLAGS}, "goog:loggingPrefs": {"browser": "ALL"}}
        self.root += "/" + self.call("", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]

    def call(self, path, body=None, method=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(f"{path}: {error.read().decode()[:400]}") from None

    def close(self):
        try:
            self.call("", method="DELETE")
        finally:
            self.driver.terminate()

    def js(self, script, *args):
        return self.call("/execute/sync", {"script": script, "args": args})

    def cdp(self, command, **params):
        return self.call("/goog/cdp/execute", {"cmd": command, "params": params})

    def window(self, width, scale):
        """A window, or a phone if it is small: the smaller, the sooner are pictures drawn."""
        phone = width < 500
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=780, deviceScaleFactor=scale, mobile=phone)

    def wait(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not self.js(f"return Boolean({condition})"):
            assert time.monotonic() < end, f"{what}: not within {PATIENCE} s; {self.console()}"
            time.sleep(0.02)

    def element(self, selector):
        return self.call("/element", {"using": "css selector", "value": selector})[ELEMENT]

    def keys(self, *keys):
        pressed = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        self.call("/actions", {"actions": [{"type": "key", "id": "keys", "actions": pressed}]})

    def drag(self, kind, *paths):
        """Moves a mouse or fingers over the picture, from its middle, along one path each."""
        origin = {ELEMENT: self.element("#picture")}
        fingers = []
        for number, (start, end) in enumerate(paths):
            move = lambda to, time: {"type": "pointerMove", "origin": origin, "x": to[0], "y": to[1], "duration": time}
            steps = [move(start, 0), {"type": "pointerDown", "button": 0}, move(end, 60), {"type": "pointerUp", "button": 0}]
            fingers.append({"type": "pointer", "id": f"{kind}{number}", "parameters": {"pointerType": kind}, "actions": steps})
        self.call("/actions", {"actions": fingers})
        self.call("/actions", method="DELETE")

    def console(self):
        return [entry for entry in self.call("/se/log", {"type": "browser"}) if entry["level"] != "INFO"]


class Page:
    """The page, as a person uses it."""

    def __init__(self, browser, address, program):
        self.browser, self.address, self.program = browser, address, program

    def load(self):
        self.browser.call("/url", {"url": self.address})
        self.finished()

    def finished(self):
        """Waits until the picture is complete; its view."""
        self.browser.js("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        self.browser.wait("picture.dataset.state === 'done'", "the picture")
        return json.loads(self.browser.js("return picture.dataset.view"))

    def hash(self):
        self.finished()
        return self.browser.js("""
            const scratch = new OffscreenCanvas(picture.width, picture.height).getContext("2d", { willReadFrequently: true });
            scratch.drawImage(picture, 0, 0);
            const { data } = scratch.getImageData(0, 0, picture.width, picture.height);
            return crypto.subtle.digest("SHA-256", data)
                .then((sum) => [...new Uint8Array(sum)].map((byte) => byte.toString(16).padStart(2, "0")).join(""));""")

    def choose(self, field, value):
        """Sets a field as a person would, and lets the page know."""
        self.browser.js("""
            const [field, value] = arguments, input = document.querySelector(field);
            picture.dataset.state = "asked";
            if (input.type === "checkbox") input.checked = value; else input.value = value;
            input.dispatchEvent(new Event(input.type === "range" ? "input" : "change", { bubbles: true }));""", field, value)
        self.finished()

    def native(self, model, structure=3, preset=1):
        """The hash of the same picture by the library on this machine."""
        view = json.loads(self.browser.js("return picture.dataset.view"))
        names = "width height yaw pitch zoom terms bounces samples heat".split()
        numbers = [model, structure, preset, *(view[name] for name in names)]
        drawn = subprocess.run([self.program, *map(str, numbers)], capture_output=True, check=True).stdout
        return hashlib.sha256(drawn).hexdigest()

    def give(self, path):
        """Gives a file to the page; the sentence with which it refuses, if it does."""
        self.browser.js("picture.dataset.state = 'asked'; delete picture.dataset.refused")
        self.browser.call(f"/element/{self.browser.element('#file')}/value", {"text": str(path)})
        self.browser.wait("picture.dataset.refused || picture.dataset.state === 'done'", f"the file {path.name}")
        return self.browser.js("return message.hidden ? null : message.textContent")

    def text(self, name):
        return self.browser.js("return document.getElementById(arguments[0]).textContent", name)


def check_load(page):
    times = []
    for _ in range(4):
        page.browser.call("/url", {"url": page.address})
        page.browser.wait("performance.getEntriesByName('first picture').length", "the first picture")
        times.append(page.browser.js("""
            const loaded = performance.getEntriesByType("navigation")[0].loadEventStart;
            const marks = ["first tile", "first picture"].map((name) => performance.getEntriesByName(name)[0].startTime);
            return [...marks.map((mark) => mark - loaded), loaded];"""))
    # Printed, not judged: machines that run checks are busy with others.
    tile, picture, loaded = (min(column) for column in zip(*times))
    print(f"loaded in {loaded:.0f} ms; first tile {tile:.0f} ms later (100), first picture {picture:.0f} ms later (1000)")
    figures = {name: page.text(name) for name in ("primitives", "bytes", "build", "speed", "time")}
    print(", ".join(f"{name} {figure}" for name, figure in figures.items()))


def check_pictures(page):
    smooth = page.hash()
    assert smooth == page.native(0), "with smooth edges it differs from the library's"
    page.choose("#smooth", False)
    for model in (1, 2, 0):
        page.choose("#model", str(model))
        assert page.hash() == page.native(model), f"model {model} differs from the library's"
    usual = page.hash()
    for structure in (1, 2, 4, 5, 6):
        page.choose("#structure", str(structure))
        assert page.hash() == usual, f"structure {structure} draws another picture"
    page.choose("#structure", "3")
    for preset in ("0", "2", "1"):
        page.choose("#preset", preset)
        assert page.hash() == usual, f"preset {preset} draws another picture"
    page.choose("#heat", True)
    assert page.hash() == page.native(0), "nodes differ from the library's"
    assert float(page.text("nodes")) > 1, "no nodes are counted"
    page.choose("#heat", False)
    seen = {smooth, usual}
    for term in range(5):
        page.choose(f"[data-term='{term}']", False)
        seen.add(page.hash())
        assert page.hash() == page.native(0), f"without term {term} it differs from the library's"
        page.choose(f"[data-term='{term}']", True)
    for bounces in (0, 6, 2):
        page.choose("#bounces", bounces)
        seen.add(page.hash())
    # No bounce is the same as no reflections.
    assert len(seen) == 8, f"{len(seen)} different pictures instead of 8"
    assert page.hash() == usual, "the way back leads elsewhere"
    print("pictures: the same bytes as the library's; the same for every structure")


def check_camera(page):
    browser = page.browser
    start = page.finished()
    browser.js("picture.focus()")
    browser.keys("\ue014", "\ue013", "+")
    view = page.finished()
    assert view["yaw"] < start["yaw"] and view["pitch"] > start["pitch"] and view["zoom"] > 1, f"keys: {view}"
    assert page.hash() == page.native(0), "turned, it differs from the library's"
    browser.keys("\ue011")
    assert page.finished() == start, "Home does not lead home"
    browser.drag("mouse", [(0, 0), (120, 40)])
    dragged = page.finished()
    assert dragged["yaw"] < start["yaw"] and dragged["pitch"] > start["pitch"], f"mouse: {dragged}"
    browser.drag("touch", [(0, 0), (-60, 0)])
    touched = page.finished()
    assert touched["yaw"] > dragged["yaw"], f"touch: {touched}"
    browser.drag("touch", [(-40, 0), (-120, 0)], [(40, 0), (120, 0)])
    pinched = page.finished()
    assert pinched["zoom"] > 1.5, f"pinch: {pinched}"
    assert page.hash() == page.native(0), "zoomed, it differs from the library's"
    browser.keys("\ue011")
    home = page.hash()
    # Without a structure a picture takes a minute; the page stays live, and lets go of it at once.
    browser.js("const s = document.querySelector('#structure'); s.value = '0'; s.dispatchEvent(new Event('change'))")
    browser.wait("bytes.textContent === '0 B'", "the list")
    browser.keys("\ue014")
    browser.wait("progress.value > 0 && progress.value < 1", "a part of a picture")
    browser.keys("\ue011")
    page.choose("#structure", "3")
    assert page.hash() == home, "a picture that was given up leaves traces"
    # Every field can be reached, and has a name.
    reached = set()
    for _ in range(20):
        browser.keys("\ue004")
        reached.add(browser.js("return document.activeElement.id || document.activeElement.dataset.term || ''"))
    assert {"model", "file", "structure", "preset", "bounces", "smooth", "heat", "0", "4"} <= reached, reached
    nameless = browser.js("return [...document.querySelectorAll('input, select')].filter((e) => !e.labels.length).length")
    assert nameless == 0, f"{nameless} fields without a label"
    print("camera: keys, mouse and fingers turn and zoom; every field can be reached by keyboard")


def tetrahedron():
    """Corners and faces."""
    return [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def glb():
    points, faces = tetrahedron()
    blob = b"".join(struct.pack("<3f", *point) for point in points) + b"".join(struct.pack("<3H", *face) for face in faces)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "buffers": [{"byteLength": 72}],
        "nodes": [{"mesh": 0, "translation": [5, 0, 0], "rotation": [0, 0, 0, 1], "scale": [2, 2, 2]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunk = lambda kind, data: struct.pack("<I4s", len(data), kind) + data
    body = chunk(b"JSON", text) + chunk(b"BIN\0", blob)
    gltf = {**document, "buffers": [{"byteLength": 72, "uri": "data:;base64," + base64.b64encode(blob).decode()}]}
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body, json.dumps(gltf).encode()


def check_files(page, folder):
    points, faces = tetrahedron()
    obj = "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join("f " + " ".join(str(c + 1) for c in f) + "\n" for f in faces)
    corners = [[points[corner] for corner in face] for face in faces]
    stl = b" " * 80 + struct.pack("<I", 4) + b"".join(
        bytes(12) + b"".join(struct.pack("<3f", *point) for point in face) + bytes(2) for face in corners)
    text = "solid x\n" + "".join("".join(f"vertex {x} {y} {z}\n" for x, y, z in face) for face in corners)
    binary, plain = glb()
    good = {"a.obj": obj.encode(), "quad.OBJ": b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 -3 -2 4 # all\n",
            "a.stl": stl, "text.stl": text.encode(), "a.glb": binary, "a.gltf": plain}
    bad = {"empty.obj": b"", "points.obj": b"v 0 0 0\n", "far.obj": b"v 0 0 0\nf 1 2 3\n", "nan.obj": b"v x 0 0\n",
           "diary.stl": b"Dear diary", "short.stl": stl[:-1], "short.glb": binary[:-40], "text.gltf": b"{}",
           "half.gltf": plain[:-9], "model.xyz": b"1 2 3", "huge.obj": b"v 1e38 0 0\nv 0 1e38 0\nv 0 0 0\nf 1 2 3\n",
           "large.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f 1 2 3\n" * 300_001}
    for name, contents in {**good, **bad}.items():
        (folder / name).write_bytes(contents)
    for name in good:
        refused = page.give(folder / name)
        assert refused is None, f"{name}: {refused}"
        page.finished()
        assert page.text("primitives") == ("4" if "quad" in name.lower() else "6"), f"{name}: {page.text('primitives')}"
    shown = page.hash()
    page.choose("#structure", "0")
    assert page.hash() == shown, "the list, which all others must equal, draws another picture"
    page.choose("#structure", "3")
    for name in bad:
        refused = page.give(folder / name)
        assert refused and name in refused, f"{name} was taken, or without a word: {refused}"
        page.browser.js("picture.dataset.state = 'done'")
        assert page.hash() == shown, f"{name} changed the picture"
        print(f"    {refused}")
    page.choose("#heat", True)
    page.choose("#heat", False)
    assert page.hash() == shown, "after files that are none, the page draws something else"
    page.browser.js("""
        const items = new DataTransfer();
        items.items.add(new File(arguments, "dropped.obj"));
        picture.dataset.state = "asked";
        document.dispatchEvent(new DragEvent("drop", { dataTransfer: items, cancelable: true }));""", obj)
    page.finished()
    assert page.browser.js("return model.selectedOptions[0].textContent") == "dropped.obj"
    assert page.text("message") == "", "the complaint is still there"
    print("files: OBJ, STL and glTF are drawn; what is none is refused in a sentence, the model on the screen stays")


def check_looks(page, screenshot):
    browser = page.browser
    for scheme in ("dark", "light"):
        browser.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        for selector in ("h1", "header p", "dd", "label", "legend", "figcaption"):
            ratio = contrast(*browser.js("""
                const scratch = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
                const rgb = (color) => { scratch.fillStyle = color; scratch.fillRect(0, 0, 1, 1); return [...scratch.getImageData(0, 0, 1, 1).data]; };
                let back = document.querySelector(arguments[0]), front = getComputedStyle(back).color;
                while (getComputedStyle(back).backgroundColor === "rgba(0, 0, 0, 0)") back = back.parentElement;
                return [rgb(front), rgb(getComputedStyle(back).backgroundColor)];""", selector))
            assert ratio >= 4.5, f"{scheme}: {selector} has a contrast of {ratio:.1f}"
    browser.window(1280, 1)
    page.load()
    if screenshot:
        pathlib.Path(screenshot).write_bytes(base64.b64decode(browser.call("/screenshot")))
    browser.window(360, 2)
    page.load()
    assert browser.js("return document.documentElement.scrollWidth <= 360"), "a phone must scroll sideways"
    assert page.hash() == page.native(0), "on a phone it differs from the library's"
    if screenshot:
        pathlib.Path(screenshot).with_suffix(".phone.png").write_bytes(base64.b64decode(browser.call("/screenshot")))
    print("looks: readable in dark and light, one column on a phone")


def contrast(front, back):
    """By WCAG 2."""
    linear = lambda x: x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4
    light = lambda color: sum(share * linear(part / 255) for share, part in zip((0.2126, 0.7152, 0.0722), color))
    less, more = sorted((light(front), light(back)))
    return (more + 0.05) / (less + 0.05)


def check_without(page):
    script = page.browser.cdp("Page.addScriptToEvaluateOnNewDocument", source="delete globalThis.WebAssembly")
    page.browser.call("/url", {"url": page.address})
    page.browser.wait("!message.hidden && message.textContent.includes('WebAssembly')", "a word on WebAssembly")
    page.browser.cdp("Page.removeScriptToEvaluateOnNewDocument", **script)
    print("without WebAssembly: a sentence")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def main():
    program, screenshot = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    size = (HERE / "hitscan.wasm").stat().st_size
    print(f"hitscan.wasm: {size:,} bytes")
    assert size <= MOST_BYTES, f"more than {MOST_BYTES:,}"
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=HERE))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    browser = Browser()
    try:
        page = Page(browser, f"http://127.0.0.1:{server.server_port}/", program)
        check_load(page)
        browser.window(320, 1)
        page.load()
        check_pictures(page)
        check_camera(page)
        with tempfile.TemporaryDirectory() as folder:
            check_files(page, pathlib.Path(folder))
        check_looks(page, screenshot)
        check_without(page)
        assert not (errors := browser.console()), errors
        print("console: no error, no warning")
    finally:
        browser.close()
        server.shutdown()


if __name__ == "__main__":
    main()
