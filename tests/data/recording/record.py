#!/usr/bin/env python3
"""Makes the recording that the page's tests replay: python3 record.py URL FOLDER, at a server started as
`sinew serve nottingham-tpcj --demo --record SOMEWHERE --port 8765`. Homes the simulated arm, moves it, cuts a tendon and
mends it, holds another one fast until it is over-tensioned; keeps two pictures. Every few rows are kept, so that the file stays small."""
import json
import struct
import sys
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
import zlib

url, folder = sys.argv[1].rstrip("/"), sys.argv[2]
every = 4
lease, held, section = "", None, 0


def call(path, body=None, kind="application/json"):
    data = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
    request = urllib.request.Request(url + path, data, {"Content-Type": kind} if data is not None else {})
    with urllib.request.urlopen(request) as answer:
        return answer.read()


def order(name, **fields):
    try:
        return json.loads(call("/api/device/" + name, fields))
    except urllib.error.HTTPError as error:
        return json.loads(error.read())


def beat():
    """A lease and a held button live for 300 ms."""
    while True:
        if lease:
            order("lease", lease=lease)
        if held:
            order(held, lease=lease, held=True, section=section)
        time.sleep(0.08)


def frames():
    with urllib.request.urlopen(url + "/api/device/events") as events:
        name = b""
        for line in events:
            if line.startswith(b"event: "):
                name = line[7:].strip()
            elif line.startswith(b"data: ") and name == b"frame":
                global frame
                frame = json.loads(line[6:])


def hold(button, seconds=0.0, until=lambda: True, of=0):
    global held, section
    held, section = button, of
    begin = time.monotonic()
    while time.monotonic() - begin < seconds or not until():
        time.sleep(0.02)
        if time.monotonic() - begin > 300:
            raise SystemExit(f"{button}: it does not come to an end: {json.dumps(frame)[:2000]}")
    held = None
    order(button, lease=lease, held=False, section=of)
    time.sleep(0.2)


def png(seed):
    """What a camera might see: rings, 160 x 120."""
    rows = b""
    for y in range(120):
        rows += b"\0" + bytes(
            (int(0.6 * ((x - 60 - seed) ** 2 + (y - 60) ** 2) ** 0.5) * 9 + seed) % 200 + 30 for x in range(160)
        )
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 160, 120, 8, 0, 0, 0, 0)) + chunk(
        b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def snapshot(words, seed):
    return json.loads(call("/api/device/snapshot?text=" + urllib.parse.quote(words), png(seed), "image/png"))["name"]


frame = None
threading.Thread(target=frames, daemon=True).start()
while not frame or frame["link"] != "ok":
    time.sleep(0.05)
lease = order("lease")["lease"]
threading.Thread(target=beat, daemon=True).start()
hold("home", until=lambda: frame["homed"] and frame["activity"] != "homing")
time.sleep(1.5)

order("speed", lease=lease, tendon=0.006)
order("arm", lease=lease)
while frame["state"] != "armed":
    time.sleep(0.02)
    if frame["why"].startswith("the recording"):
        raise SystemExit(frame["why"])
name = frame["recording"]["name"]
pictures = []
order("target", lease=lease, bends=[[0.1, -0.05], [0.15, 0.1], [-0.1, 0.12], [0.2, -0.15], [0.15, 0.2]], stage=0.008)
hold("move", 1.2)
pictures.append(snapshot('at the "first" target', 10))
order("fault", line="cut 3 1")
hold("move", 0.5)
time.sleep(0.8)
order("fault", line="mend")
time.sleep(1.2)
order("target", lease=lease, bends=[[0.1, -0.05], [-0.2, -0.2], [-0.1, 0.12], [0.2, -0.15], [0.15, 0.2]], stage=0.008)
order("fault", line="stick 2 1")
hold("move", 1.0, until=lambda: frame["state"] != "armed" or frame["activity"] == "rest")
try:
    pictures.append(snapshot("after it was disarmed", 60))
except urllib.error.HTTPError as error:
    print("no second picture:", error.read().decode(), file=sys.stderr)
time.sleep(1.5)
print(frame["why"], "|", [one["word"] for one in frame["sections"]], file=sys.stderr)
order("fault", line="free")
order("release", lease=lease)

open(f"{folder}/{name}.csv", "wb").write(call(f"/api/recordings/{name}?every={every}"))
for picture in pictures:
    number = picture[-7:-4]
    open(f"{folder}/{picture}", "wb").write(call(f"/api/recordings/{name}/snapshots/{number}"))
print(name)
