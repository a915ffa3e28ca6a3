# SPDX-License-Identifier: MIT
"""The worst file of each kind: as much work and memory for its bytes as the kind allows."""

import json
import struct


def parameter(group, name, kind, dimensions, data):
    content = struct.pack(f"<bB{len(dimensions)}B", kind, len(dimensions), *dimensions) + data + b"\0"
    return struct.pack("<bb", len(name), group) + name.encode() + struct.pack("<H", len(content) + 2) + content


def c3d(labels, frames, more=b""):
    """Intel, floats; every point is seen in every frame."""
    width = max(map(len, labels))
    section = struct.pack("<bb", 5, -1) + b"POINT" + struct.pack("<H", 3) + b"\0"
    section += parameter(1, "USED", 2, [], struct.pack("<H", len(labels)))
    section += parameter(1, "RATE", 4, [], struct.pack("<f", 100))
    for part in range(0, len(labels), 255):
        texts = labels[part:part + 255]
        name = "LABELS" + (str(part // 255 + 1) if part else "")
        section += parameter(1, name, -1, [width, len(texts)], b"".join(text.ljust(width).encode() for text in texts))
    section = b"\x01\x50\x00\x54" + section + more + b"\0\0"
    section += bytes(-len(section) % 512)
    header = bytearray(512)
    header[0:2] = b"\x02\x50"
    struct.pack_into("<HHHHHfHHf", header, 2, len(labels), 0, 1, min(frames, 65535), 10, -1, 2 + len(section) // 512, 0, 100)
    points = b"".join(struct.pack("<4f", i % 500, i % 300, i % 1700, 0) for i in range(len(labels)))
    return bytes(header) + section + points * frames


def c3d_labels(n):
    return c3d([f"{i:06}" for i in range(6000 * n)], 1)


def c3d_frames(n):
    return c3d([f"M{i:02}" for i in range(50)], 500 * n)


def c3d_parameters(n):
    return c3d(["A", "B", "C"], 1, b"".join(parameter(1, f"P{i}", 2, [], b"\0\0") for i in range(1100 * n)))


def trc(labels, frames):
    lines = ["PathFileType\t4\t(X/Y/Z)\tw.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
             f"100\t100\t{frames}\t{labels}\tmm", "Frame#\tTime\t" + "".join(f"m{i}\t\t\t" for i in range(labels)), ""]
    for k in range(frames):
        lines.append(f"{k + 1}\t{k / 100}" + "".join(f"\t{i % 500}\t1\t{i % 1700}" for i in range(labels)))
    return "\n".join(lines).encode()


def trc_labels(n):
    return trc(8000 * n, 2)


def trc_frames(n):
    return trc(3, 8000 * n)


def trc_short_rows(n):
    return trc(1000, 1) + b"\n1\t1" * 30000 * n


def mmm(inside):
    return f"<MMM version='2.0'>{inside}</MMM>".encode()


def sensor(kind, configuration, measurements):
    return mmm(f"<Motion name='m'><Sensors><Sensor type='{kind}'><Configuration>{configuration}</Configuration>"
               f"<Data>{measurements}</Data></Sensor></Sensors></Motion>")


def mmm_measurements(n):
    return sensor("MoCapMarker", "", "".join(
        f"<Measurement timestep='{k / 100}'><MarkerPosition name='a'>1 2 3</MarkerPosition></Measurement>" for k in range(4000 * n)))


def mmm_labels(n):
    return sensor("MoCapMarker", "", "<Measurement timestep='0'>" + "".join(
        f"<MarkerPosition name='{i}'>1 2 3</MarkerPosition>" for i in range(6000 * n)) + "</Measurement>")


def mmm_joints(n):
    return sensor("Kinematic", "".join(f"<Joint name='joint_{i}'/>" for i in range(8000 * n)),
                  f"<Measurement timestep='0'><JointPosition>{'0 ' * 8000 * n}</JointPosition></Measurement>")


def mmm_postures(n):
    pose = "<RootPosition>1 2 3</RootPosition><RootRotation>0 0 0</RootRotation>"
    return sensor("ModelPose", "", "".join(f"<Measurement timestep='{k / 100}'>{pose}</Measurement>" for k in range(4000 * n)))


def mmm_motions(n):
    return mmm("<Motion name='m000000'></Motion>" * 20000 * n)


def xml_elements(n):
    return mmm("<element_abcde/>" * 30000 * n)


def xml_attributes(n):
    return mmm("<element a='' attribute=''/>" * 20000 * n)


def xml_too_short(n):
    return mmm("<a/>" * 200000 * n)


def model_nodes(n):
    names = [f"n{i}" for i in range(500 * n)]
    children = "".join(f"<Child name='{name}'/>" for name in names[1:])
    nodes = "".join(f"<RobotNode name='{name}'/>" for name in names[1:])
    return f"<Robot Type='a' RootNode='n0'><RobotNode name='n0'>{children}</RobotNode>{nodes}</Robot>".encode()


def urdf_links(n):
    links = "".join(f"<link name='l{i}'/>" for i in range(500 * n))
    joints = "".join(f"<joint name='j{i}' type='continuous'><parent link='l{i - 1}'/><child link='l{i}'/></joint>"
                     for i in range(1, 500 * n))
    return f"<robot name='r'>{links}{joints}</robot>".encode()


def configuration(n):
    mappings = "".join(f"<Mapping source='{i}' target='{i}'/>" for i in range(8000 * n))
    return (f"<ConverterConfig type='S2KFConverter'><Model><MarkerMapping>{mappings}</MarkerMapping></Model>"
            "</ConverterConfig>").encode()


def marker_set(n):
    return ("<MarkerSet name='a'>" + "".join(f"<Mapping source='{i}' target='{i}'/>" for i in range(8000 * n)) +
            "</MarkerSet>").encode()


def manifest(n):
    return ("<Batch>" + "".join(f"<Recording file='{i}.c3d'/>" for i in range(6000 * n)) + "</Batch>").encode()


def manifest_of_heirs(n):
    """What a group says holds for each of its recordings."""
    return (f"<Batch><Metadata name='a' value='{'a' * 40000 * n}'/>" +
            "".join(f"<Recording file='{i}.c3d'/>" for i in range(300 * n)) + "</Batch>").encode()


def journal(n):
    state = {"bytes": 1, "modified_ns": 1, "hash": "h"}
    return "".join(json.dumps({"id": str(i), "time_ms": i, "converted": False, "fingerprint": "", "recording": state,
                               "outputs": {}, "result": {"state": "failed", "reason": "r", "seconds": 0.0}}) + "\n"
                   for i in range(1500 * n)).encode()


def summary(n):
    return b'{"a":[' + b"[],{}," * 30000 * n + b"0]}"


def table(n):
    return b"time_s,root_x_mm\n" + b"0,0\n" * 60000 * n


# Name of the file, its content, whether it is read (else refused at this size), and how many bytes of memory `info` takes
# for each of the file: that is 20, and more only where the number of what takes it is limited (common/io/README.md).
WORST = [("labels.c3d", c3d_labels, True, 110), ("frames.c3d", c3d_frames, True, 20),
         ("parameters.c3d", c3d_parameters, True, 60), ("labels.trc", trc_labels, True, 40),
         ("frames.trc", trc_frames, True, 20), ("short_rows.trc", trc_short_rows, False, 40), ("measurements.xml", mmm_measurements, True, 20),
         ("labels.xml", mmm_labels, True, 25), ("joints.xml", mmm_joints, True, 20),
         ("postures.xml", mmm_postures, True, 20), ("motions.xml", mmm_motions, False, 20),
         ("elements.xml", xml_elements, False, 20), ("attributes.xml", xml_attributes, False, 25),
         ("too_short.xml", xml_too_short, False, 20), ("model.xml", model_nodes, True, 75),
         ("robot.urdf", urdf_links, True, 50), ("configuration.xml", configuration, True, 20),
         ("marker_set.xml", marker_set, True, 25), ("manifest.xml", manifest, True, 100),
         ("heirs.xml", manifest_of_heirs, False, 20),
         ("journal.jsonl", journal, True, 20), ("summary.json", summary, True, 30), ("table.csv", table, True, 20)]
