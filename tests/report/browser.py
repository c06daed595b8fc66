"""A real Chromium, driven over its debugging pipe: pages as a reader meets them, mouse and keyboard included."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import tarfile
import time
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

PROGRAM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
AXE = "4.14.1"
FLAGS = (
    "--headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --no-first-run --disable-sync"
    " --disable-background-networking"
)


class Browser:
    """One page of one browser. ``problems`` collects what it complains about."""

    def __init__(self, profile: Path) -> None:
        (theirs_in, ours_out), (ours_in, theirs_out) = os.pipe(), os.pipe()
        command = f'exec "$0" "$@" 3<&{theirs_in} 4>&{theirs_out}'
        options = [*FLAGS.split(), "--force-prefers-reduced-motion", "--remote-debugging-pipe"]
        self.process = subprocess.Popen(
            ["bash", "-c", command, str(PROGRAM), *options, f"--user-data-dir={profile}", "about:blank"],
            pass_fds=(theirs_in, theirs_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(theirs_in), os.close(theirs_out)
        self.sent, self.received, self.pending = os.fdopen(ours_out, "wb", 0), os.fdopen(ours_in, "rb", 0), b""
        self.number, self.session, self.problems = 0, "", list[str]()
        self.loaded: dict[str, str] = {}
        pages = [target for target in self.call("Target.getTargets")["targetInfos"] if target["type"] == "page"]
        self.session = self.call("Target.attachToTarget", targetId=pages[0]["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.sent.write(json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(answer["error"]["message"])
                return answer["result"]
            self._notice(answer.get("method"), answer.get("params", {}))

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self.pending:
            data = self.received.read(1 << 16)
            assert data, "the browser has gone"
            self.pending += data
        message, _, self.pending = self.pending.partition(b"\0")
        return json.loads(message)

    def _notice(self, method: str | None, parameters: dict[str, Any]) -> None:
        if method in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"):
            self.problems.append(json.dumps(parameters)[:600])
        if method == "Network.requestWillBeSent":
            self.loaded[parameters["requestId"]] = parameters["request"]["url"]
        if method == "Network.loadingFailed":
            self.problems.append(f"{self.loaded.get(parameters['requestId'])}: {parameters['errorText']}")

    def open(self, path: Path, anchor: str = "") -> None:
        """Load a page from disk and wait until it is complete."""
        self.call("Page.navigate", url="about:blank")
        self.loaded.clear()
        self.call("Page.navigate", url=path.resolve().as_uri() + anchor)
        self.wait(f"document.readyState == 'complete' && location.protocol == 'file:' && {json.dumps(path.name)}")

    def wait(self, condition: str, seconds: float = 20) -> None:
        end = time.time() + seconds
        while time.time() < end:
            with contextlib.suppress(RuntimeError):  # asked while another page is being loaded
                if self.js(condition):
                    return
            time.sleep(0.05)
        raise AssertionError(f"never came true: {condition}")

    def weight(self) -> float:
        """What has been loaded from disk since ``open`` [kB]: the page and what it loads before anything is opened."""
        self.js("new Promise((done) => setTimeout(done, 400))")  # pictures that are nearly in view
        files = {url for url in self.loaded.values() if url.startswith("file:")}
        return sum(Path(unquote(urlsplit(url).path)).stat().st_size for url in files) / 1000

    def js(self, expression: str) -> Any:
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result["exceptionDetails"]
        return result["result"].get("value")

    def screen(self, width: int, height: int, dark: bool = False) -> None:
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def mouse(self, kind: str, x: float, y: float, pressed: bool = False) -> None:
        button = "left" if pressed or kind != "mouseMoved" else "none"
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=int(pressed), clickCount=1)

    def key(self, key: str) -> None:
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(20)


def axe(cache: Path) -> str | None:
    """The source of axe-core, the accessibility tests, fetched once; None without npm or network."""
    stored = cache / f"axe-{AXE}.min.js"
    if not stored.exists():
        cache.mkdir(parents=True, exist_ok=True)
        command = ["npm", "pack", f"axe-core@{AXE}", "--silent", "--pack-destination", str(cache)]
        if not shutil.which("npm") or subprocess.run(command, capture_output=True, check=False).returncode:
            return None
        with tarfile.open(cache / f"axe-core-{AXE}.tgz") as archive:
            member = archive.extractfile("package/axe.min.js")
            assert member
            stored.write_bytes(member.read())
    return stored.read_text()
