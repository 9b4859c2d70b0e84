#!/usr/bin/env python3
"""Makes the recording that the page's tests replay: python3 record.py URL FOLDER, at a server started as
`sinew serve nottingham-tpcj --demo --record SOMEWHERE --port 8765`. Homes the simulated arm, drives it along a plan and to a target,
cuts a tendon and mends it, retracts, holds another tendon fast until it is over-tensioned, and unplugs the device; keeps a picture.
Of the measurements few are kept, so that the file stays small."""
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
most_rows = 80
lease, held = "", None


def call(path, body=None, kind="application/json"):
    data = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
    request = urllib.request.Request(url + path, data, {"Content-Type": kind} if data is not None else {})
    with urllib.request.urlopen(request) as answer:
        return answer.read()


def order(what, **fields):
    try:
        return json.loads(call("/api/device/" + what, fields))
    except urllib.error.HTTPError as error:
        return json.loads(error.read())


def must(what, **fields):
    answer = order(what, **fields)
    if "error" in answer:
        raise SystemExit(f"{what}: {answer['error']['message']}")
    time.sleep(0.15)  # until frames tell of it
    return answer


def beat():
    """A lease and a held button live for 300 ms."""
    while True:
        if lease:
            order("lease", lease=lease)
        if held:
            order(held, lease=lease, held=True)
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


def wait(until):
    begin = time.monotonic()
    while not until(frame):
        time.sleep(0.02)
        if time.monotonic() - begin > 60:
            raise SystemExit(f"it does not come: {json.dumps(frame)[:2000]}")


def words(frame):
    return [section["word"] for section in frame["sections"]]


def is_there(frame):
    return all(abs(a - b) < 3e-3 for section in frame["sections"] for a, b in zip(section["target"], section["measured"]))


def hold(button, until):
    global held
    held = button
    wait(until)
    held = None
    order(button, lease=lease, held=False)
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


frame = None
threading.Thread(target=frames, daemon=True).start()
wait(lambda frame: frame and frame["link"] == "ok")
lease = must("lease")["lease"]
threading.Thread(target=beat, daemon=True).start()
hold("home", lambda frame: frame["homed"] and frame["activity"] != "homing")
wait(lambda frame: words(frame) == ["EXACT"] * 5 and not frame["recording"])

must("speed", lease=lease, tendon=0.006)
must("arm", lease=lease)
wait(lambda frame: frame["state"] == "armed")
name = frame["recording"]["name"]
way_in = [[0.1, -0.05], [0.15, 0.1], [-0.1, 0.12], [0.2, -0.15], [0.15, 0.2]]
steps = [{"bends": [[k / 4 * x, k / 4 * y] for x, y in way_in], "stage": k / 4 * 0.012} for k in range(5)]
must("plan", lease=lease, robot=json.loads(call("/api/device"))["device"]["robot"], name="way in", steps=steps)
hold("follow", lambda frame: frame["plan"]["done"])
must("plan", lease=lease)
picture = json.loads(call("/api/device/snapshot?text=" + urllib.parse.quote('at the "first" target'), png(10), "image/png"))["name"]
must("target", lease=lease, bends=[[0.1, -0.05], [0.1, 0.15], [-0.1, 0.12], [0.2, -0.15], [0.05, 0.25]], stage=0.015)
hold("move", is_there)
must("fault", line="cut 3 1")
wait(lambda frame: words(frame)[2] == "PARTLY SLACK")
time.sleep(0.5)
must("fault", line="mend")
wait(lambda frame: words(frame) == ["EXACT"] * 5)
hold("retract", lambda frame: frame["insertion"] < 0.011)
# A tendon that is stuck, and then all is gone: the recording ends a second later.
must("target", lease=lease, bends=[[0.1, -0.05], [-0.3, -0.3], [-0.1, 0.12], [0.2, -0.15], [0.15, 0.2]])
must("fault", line="stick 2 1")
hold("move", lambda frame: frame["state"] != "armed")
must("fault", line="unplug")
wait(lambda frame: not frame["recording"])
must("fault", line="plug")
wait(lambda frame: frame["link"] == "ok")
print(frame["why"], "|", words(frame), file=sys.stderr)
must("fault", line="free")
must("release", lease=lease)

recorded = next(one for one in json.loads(call("/api/recordings"))["recordings"] if one["name"] == name)
every = -(-recorded["rows"] // most_rows)
for path, kept in ((f"{name}?every={every}", ".csv"), (f"{name}/snapshots/{picture[-7:-4]}", picture[-8:])):
    content = call(f"/api/recordings/{path}")
    open(f"{folder}/nottingham-tpcj{kept}", "wb").write(content.replace(name.encode(), b"nottingham-tpcj"))
