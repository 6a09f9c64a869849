"""Writes the bags of tests/files: wrenches of a wheel that was never built, under the licence of this repository.

    python make_bags.py         # needs rosbags; the committed files were made with 0.11
"""

import pathlib

from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

FILES = pathlib.Path(__file__).resolve().parent / "files"
TYPES = get_typestore(Stores.ROS1_NOETIC)
BEGIN_NS = 1_637_060_000_000_000_000
TARE = (0.3, 1.5, -2.0)


def wrench(t_ns, force):
    types = TYPES.types
    vector = types["geometry_msgs/msg/Vector3"]
    stamp = types["builtin_interfaces/msg/Time"](sec=t_ns // 10**9, nanosec=t_ns % 10**9)
    header = types["std_msgs/msg/Header"](seq=0, stamp=stamp, frame_id="sensor")
    values = types["geometry_msgs/msg/Wrench"](force=vector(*force), torque=vector(3.0, 0.25, 0.0))
    return types["geometry_msgs/msg/WrenchStamped"](header=header, wrench=values)


def bag(name, forces):
    path = FILES / name
    path.unlink(missing_ok=True)
    with Writer(path) as writer:
        remarks = writer.add_connection("/remarks", "std_msgs/msg/String", typestore=TYPES)
        axes = writer.add_connection("/ft_sensor", "geometry_msgs/msg/WrenchStamped", typestore=TYPES)
        text = TYPES.types["std_msgs/msg/String"](data="synthetic")
        writer.write(remarks, BEGIN_NS, TYPES.serialize_ros1(text, "std_msgs/msg/String"))
        for t_ns, force in forces:
            message = TYPES.serialize_ros1(wrench(t_ns, force), "geometry_msgs/msg/WrenchStamped")
            # A message is received 2 ms after its stamp.
            writer.write(axes, t_ns + 2_000_000, message)


def run():
    """From 0.1 s before the beginning to 3.2 s after it, every 50 ms or 30 ms: pull 20 N + 2 N/s, lateral 0, load 150 N."""
    t_ns, forces = BEGIN_NS - 100_000_000, []
    while t_ns < BEGIN_NS + 3_200_000_000:
        t_s = (t_ns - BEGIN_NS) * 1e-9
        forces.append((t_ns, (TARE[0], TARE[1] - 20.0 - 2.0 * t_s, TARE[2] - 150.0)))
        t_ns += 50_000_000 if len(forces) % 2 else 30_000_000
    return forces


bag("run.bag", run())
bag("zero.bag", [(BEGIN_NS + k * 50_000_000, tuple(tare + (0.1, -0.1)[k % 2] for tare in TARE)) for k in range(10)])
