"""Time, memory and damage of the import of bags, beside rosbags' own reading.

python -m tests.studies.recordings.bags size --folder FOLDER [--gigabytes 1] [--kind mcap ...]
python -m tests.studies.recordings.bags cut --folder FOLDER [--places 20] [--kind mcap ...]

`size` writes a bag of that size (and one of a tenth), reads and decodes every message with rosbags,
imports it, and prints times and the largest memory of either. `cut` truncates a bag at random
places, and prints how much of what was left could be read, and what was said. Bags are deleted.
For `size` the file calls itself with `one --call NAME --path BAG --out FOLDER`, so that each way of
reading has a process, and a largest memory, of its own.
"""

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from rosbags.highlevel import AnyReader

from odometry.bags.files.message_types import MessageTypes
from odometry.bags.import_bags import write_run
from odometry.bags.plan import make_plan
from odometry.bags.topics.message_fields import COMPRESSED_IMAGE
from odometry.bags.topics.topic_roles import TopicMap
from odometry.errors import BagError
from tests.odometry.bags.imports import SIZE, looked_at
from tests.odometry.bags.made_bags import BEGIN_NS, RADIUS_M, Bag, name_of, writer_of

JOINTS = ["front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"]
IMAGE_BYTES, IMAGES_HZ = 100_000, 10
RATES_HZ = {"joints": 50, "imu": 200, "poses": 20}
JPEG = b"\xff\xd8\xff"


def write_bag(path, kind, size_bytes):
    """A bag of JPEG images, joints, an inertial sensor and poses, written as a stream."""
    seconds = round(size_bytes / (IMAGE_BYTES * IMAGES_HZ))
    noise = np.random.default_rng(1).bytes(IMAGE_BYTES * 2)
    bag = Bag(kind)
    serialize = bag.types.serialize_ros1 if kind.startswith("ros1") else bag.types.serialize_cdr
    with writer_of(kind, path) as writer:
        connections = {}
        for second in range(seconds):
            bag.written = []
            one_second(bag, second, noise)
            for topic, name, t_s, message in sorted(bag.written, key=lambda one: one[2]):
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, name, typestore=bag.types)
                stamp_ns = BEGIN_NS + round(t_s * 1e9)
                writer.write(connections[topic], stamp_ns, serialize(message, name))


def one_second(bag, second, noise):
    """All messages of a second; images are noise behind the first bytes of a JPEG."""
    for number in range(RATES_HZ["joints"]):
        speed = np.sin(second / 10) / RADIUS_M
        bag.joints(second + number / RATES_HZ["joints"], JOINTS, np.zeros(4), [speed] * 4)
    for number in range(RATES_HZ["imu"]):
        bag.imu(second + number / RATES_HZ["imu"], (0.0, 0.0, 0.1), (0.0, 0.0, 9.8))
    for number in range(RATES_HZ["poses"]):
        pose = bag.pose((second, number, 0), (1, 0, 0, 0))
        bag.pose_stamped("/mocap/pose", second + number / RATES_HZ["poses"], pose)
    for number in range(IMAGES_HZ):
        begin = (second * 7919 + number * 104729) % IMAGE_BYTES
        content = JPEG + noise[begin : begin + IMAGE_BYTES]
        bag.compressed(second + number / IMAGES_HZ, content)


def read_with_rosbags(path, out=None):
    """Read and decode every message; write images to files where `out` names a folder."""
    with AnyReader([path]) as reader:
        for number, (connection, _, data) in enumerate(reader.messages()):
            message = reader.deserialize(data, connection.msgtype)
            if out is not None and connection.msgtype == COMPRESSED_IMAGE:
                (out / f"{number}.jpg").write_bytes(message.data)


def read_with_import(path, out, images):
    """Import a bag, with its images or without."""
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    types = MessageTypes()
    found = looked_at(path)[0]
    plan = make_plan(found, TopicMap().overridden({**SIZE, "images.topic": images}))
    said = write_run(found, plan, types, out, lambda _: None)
    assert said.losses == (), said.losses
    shutil.rmtree(out)


def measured(call, path, out):
    """Seconds of the processor, those of them in the kernel, and largest memory [MB], alone."""
    command = [sys.executable, __file__, "one", "--call", call, "--path", str(path)]
    done = subprocess.run([*command, "--out", str(out)], check=True, capture_output=True, text=True)
    return tuple(map(float, done.stdout.split()))


def one(arguments):
    """Time and memory of one way to read a bag."""
    begin = os.times()
    if arguments.call == "rosbags":
        read_with_rosbags(arguments.path)
    elif arguments.call == "rosbags_and_images":
        arguments.out.mkdir()
        read_with_rosbags(arguments.path, arguments.out)
        shutil.rmtree(arguments.out)
    else:
        images = None if arguments.call == "import" else "none"
        read_with_import(arguments.path, arguments.out, images)
    end = os.times()
    kernel = end.system - begin.system
    print(end.user - begin.user + kernel, kernel, peak_megabytes())


def peak_megabytes():
    """Largest memory of this process, without what it had of its parent before it began."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))


def size(arguments):
    print(
        "seconds of the processor, those of them in the kernel (copies, and files of images made),"
    )
    print("largest memory [MB], microseconds a message (over rosbags')")
    print(
        "kind  GB  messages | rosbags | import without images | rosbags, images to files | import"
    )
    for kind in arguments.kind:
        for share in (0.1, 1.0):
            folder = arguments.folder / "bags_study"
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            path = folder / name_of(kind)
            write_bag(path, kind, share * arguments.gigabytes * 1e9)
            parts = [path] if path.is_file() else list(path.iterdir())
            gigabytes = sum(part.stat().st_size for part in parts) / 1e9
            count = looked_at(path)[0].count
            seconds, kernel, megabytes = measured("rosbags", path, folder / "run")
            row = f"{kind}  {gigabytes:.2f}  {count} | {seconds:.2f} {kernel:.2f} {megabytes:.0f}"
            row += f" {seconds / count * 1e6:.1f}"
            for call in ("import_without_images", "rosbags_and_images", "import"):
                took, kernel, megabytes = measured(call, path, folder / "run")
                row += f" | {took:.2f} {kernel:.2f} {megabytes:.0f} {took / count * 1e6:.1f}"
                row += f" ({took / seconds:.2f})"
            print(row, flush=True)
            shutil.rmtree(folder)


def cut(arguments):
    rng = np.random.default_rng(15)
    for kind in arguments.kind:
        folder = arguments.folder / "bags_study"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        path = folder / name_of(kind)
        write_bag(path, kind, 2e7)
        file = path if path.is_file() else next(f for f in path.iterdir() if f.suffix != ".yaml")
        content = file.read_bytes()
        whole = looked_at(file)[0].count
        print(f"{kind}: {len(content)} bytes, {whole} messages")
        for share in np.sort(rng.uniform(0.02, 1.0, arguments.places)):
            part = folder / f"cut{file.suffix}"
            part.write_bytes(content[: int(share * len(content))])
            print(f"  {share:5.3f}  {said_of(part, whole)}", flush=True)
        shutil.rmtree(folder)


def said_of(part, whole):
    """Share of the messages that were read, and what was said."""
    with contextlib.suppress(BagError):
        found = looked_at(part)[0]
        said = "; ".join(line.replace(str(part), "FILE") for line in found.losses)
        return f"{found.count / whole:5.3f}  {said}"
    return "nothing to read"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["size", "cut", "one"])
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--gigabytes", type=float, default=1.0)
    parser.add_argument("--places", type=int, default=20)
    parser.add_argument("--kind", nargs="+", default=["mcap", "mcap_zstd", "sqlite3", "ros1"])
    parser.add_argument("--call")
    parser.add_argument("--path", type=Path)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    {"size": size, "cut": cut, "one": one}[arguments.what](arguments)


if __name__ == "__main__":
    main()
