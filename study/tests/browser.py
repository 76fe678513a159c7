# SPDX-License-Identifier: MIT
"""Opens a page in headless Chromium and looks at it: every picture is there, nothing fails or
leaves the disk, nothing is wider than the window, light and dark differ."""
import base64
import fcntl
import json
import os
import shutil
import subprocess
import tempfile
import time

TIMEOUT_S = 240
SIZES = ((1280, 800), (400, 800))
SCHEMES = ("light", "dark")
SHOT_MAX_PX = 16000  # Chromium's largest texture, less a margin

LOOK = """(async () => {
  for (const part of document.querySelectorAll('details')) part.open = true;
  const pictures = [...document.querySelectorAll('img')];
  for (const picture of pictures) picture.loading = 'eager';
  await Promise.all(pictures.map(p => p.decode().catch(() => {})));
  const root = document.documentElement, wide = [];
  for (const e of document.querySelectorAll('body *')) {
    if (e.closest('.scroll') && !e.matches('.scroll')) continue;
    const box = e.getBoundingClientRect();
    if (box.right > root.clientWidth + 1 || box.left < -1)
      wide.push(e.tagName + '.' + e.className + ' ' + e.textContent.slice(0, 40));
  }
  return {
    pictures: pictures.length,
    missing: pictures.filter(p => p.naturalWidth === 0).map(p => p.src),
    distorted: pictures.filter(p => p.naturalWidth != p.getAttribute('width') ||
      p.naturalHeight != p.getAttribute('height')).map(p => p.src),
    scroll_width: root.scrollWidth, window_width: root.clientWidth,
    height: root.scrollHeight, wide: wide.slice(0, 8),
    background: getComputedStyle(document.body).backgroundColor,
    color: getComputedStyle(document.body).color,
    scripts: document.scripts.length, title: document.title,
    plots: document.querySelectorAll('figure.plot .scroll svg').length,
    headings: document.querySelectorAll('h2').length,
  };
})()"""


class Browser:
    """Chromium on the other end of a pipe, one page in it."""

    def __init__(self, program, profile):
        to_read, self.out = os.pipe()
        self.into, to_write = os.pipe()
        # The browser wants them as 3 and 4; from above these they cannot collide.
        theirs = [fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in (to_read, to_write)]
        os.close(to_read)
        os.close(to_write)

        def connect():
            os.dup2(theirs[0], 3)
            os.dup2(theirs[1], 4)

        arguments = [program, "--headless=new", "--remote-debugging-pipe", "--disable-gpu",
                     "--no-first-run", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--disable-extensions", "--disable-background-networking",
                     "--user-data-dir=" + profile]
        if os.geteuid() == 0:
            arguments.append("--no-sandbox")
        # Both descriptors would be closed otherwise; all others close by themselves.
        self.process = subprocess.Popen(arguments, preexec_fn=connect, close_fds=False,
                                        stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        for end in theirs:
            os.close(end)
        self.deadline = time.monotonic() + TIMEOUT_S
        self.buffer = b""
        self.number = 0
        self.session = None
        self.events = []

    def receive(self):
        while b"\0" not in self.buffer:
            if time.monotonic() > self.deadline:
                raise TimeoutError("the browser does not answer")
            part = os.read(self.into, 1 << 16)
            if not part:
                raise EOFError("the browser ended")
            self.buffer += part
        line, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(line)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.out, data):]
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def open_page(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target,
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def load(self, url):
        self.events.clear()
        self.call("Page.navigate", url=url)
        while not any(e.get("method") == "Page.loadEventFired" for e in self.events):
            self.events.append(self.receive())

    def evaluate(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, awaitPromise=True,
                           returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"]))
        return answer["result"]["value"]

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
        except (OSError, EOFError, TimeoutError, RuntimeError):
            pass
        try:
            self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def faults_of_events(events):
    for event in events:
        method, what = event.get("method"), event.get("params", {})
        if method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            yield f"log: {what['entry']['text']}"
        elif method == "Runtime.exceptionThrown":
            yield f"exception: {what['exceptionDetails']['text']}"
        elif method == "Runtime.consoleAPICalled":
            yield f"console: {what['type']}"
        elif method == "Network.loadingFailed":
            yield f"not loaded: {what.get('errorText')}"
        elif method == "Network.requestWillBeSent":
            url = what["request"]["url"]
            if not url.startswith(("file:", "data:", "about:")):
                yield f"leaves the disk: {url}"


def faults_of_look(look):
    if look["pictures"] == 0 or look["headings"] == 0 or look["plots"] == 0:
        yield f"is nearly empty: {look}"
    for key in ("missing", "distorted", "wide"):
        if look[key]:
            yield f"{key}: {look[key][:4]}"
    if look["scroll_width"] > look["window_width"]:
        yield f"is {look['scroll_width']} px wide in {look['window_width']} px"
    if look["scripts"]:
        yield "has scripts"


def shoot(browser, look, width, path):
    height = min(look["height"], SHOT_MAX_PX)
    shot = browser.call("Page.captureScreenshot", format="png", captureBeyondViewport=True,
                        clip={"x": 0, "y": 0, "width": width, "height": height, "scale": 1})
    with open(path, "wb") as file:
        file.write(base64.b64decode(shot["data"]))


def find_browser():
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser",
                                                "google-chrome"))), None)


def faults_of_page(program, page, shots):
    """What is wrong with a page, as texts. Screenshots are left in the folder `shots`."""
    faults, looks = [], {}
    with tempfile.TemporaryDirectory() as profile:
        browser = Browser(program, profile)
        try:
            browser.open_page()
            for scheme in SCHEMES:
                browser.call("Emulation.setEmulatedMedia", features=[
                    {"name": "prefers-color-scheme", "value": scheme}])
                for width, height in SIZES:
                    browser.call("Emulation.setDeviceMetricsOverride", width=width,
                                 height=height, deviceScaleFactor=1, mobile=width < 600)
                    browser.load("file://" + os.path.abspath(page))
                    look = looks[scheme] = browser.evaluate(LOOK)
                    where = f"{scheme}, {width} px"
                    faults += [f"{where}: {f}" for f in faults_of_look(look)]
                    faults += [f"{where}: {f}" for f in faults_of_events(browser.events)]
                    shoot(browser, look, width, os.path.join(shots, f"{scheme}-{width}.png"))
        finally:
            browser.close()
    light, dark = looks["light"], looks["dark"]
    if light["background"] == dark["background"] or light["color"] == dark["color"]:
        faults.append(f"light and dark look the same: {light['background']}")
    return faults
