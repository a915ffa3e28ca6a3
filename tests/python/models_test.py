# SPDX-License-Identifier: MIT
"""Forward kinematics and tracking frame by frame."""
import gc
import os
import signal
import threading
import time
import unittest

import numpy as np

import mmm_chain
import mmmconverter
from support import Case, ROOT, SAMPLE


class Models(Case):

    def test_forward_is_the_models_chain(self):
        height, frames = mmm_chain.read_sensors(ROOT / "examples/handstand_true.xml")
        chain = mmm_chain.Chain(ROOT / "xml_config/models/mmm.xml", height)
        model = mmmconverter.read_model(height=height)
        motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")
        poses = model.forward(motion)
        self.assertEqual(poses.positions.shape, (675, len(model.segments), 3))
        self.assertEqual(poses.rotations.shape, (675, len(model.segments), 3, 3))
        for k in range(0, 675, 25):
            for node in mmm_chain.POINTS.values():
                expected = chain.pose(node, *frames[k])
                i = model.segments.index(node)
                np.testing.assert_allclose(poses.positions[k, i], expected[:3, 3], atol=1e-9)
                np.testing.assert_allclose(poses.rotations[k, i], expected[:3, :3], atol=1e-9)

    def test_one_posture_is_the_same(self):
        model = mmmconverter.read_model(height=1.75, mass=60)
        self.assertAlmostEqual(model.mass, 60, 6)
        motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")
        all_poses = model.forward(motion)
        one = model.forward(motion.root_positions[7], motion.root_quaternions[7], motion.joints[7],
                            motion.joint_names)
        for many, single in zip(all_poses, one):
            np.testing.assert_array_equal(many[7], single)
        still = model.forward([0, 0, 1], [1, 0, 0, 0])
        np.testing.assert_array_equal(still.positions[0], [0, 0, 1])

    def test_a_model_of_opensim_gives_its_coordinates(self):
        model, walk = (ROOT / "examples/opensim" / name for name in ("generic.osim", "walk.trc"))
        result = mmmconverter.convert(str(walk), model=str(model))
        result.save(self.folder / "python.mot")
        self.run_program("convert", walk, "--model", model, "-o", self.folder / "program.mot")
        self.assert_same_files(self.folder / "python.mot", self.folder / "program.mot")
        result.report(self.folder / "page.html")
        self.assertIn("knee_angle_r", (self.folder / "page.html").read_text())
        read = mmmconverter.read_model(str(model))
        self.assertIn("knee_angle_r", read.joint_names)
        self.assertEqual(read.forward(result).positions.shape[0], 166)

    def test_arguments_are_checked(self):
        model = mmmconverter.read_model(height=1.75)
        position, quaternion = np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1))
        for arguments, message in (
                ((position, quaternion, np.zeros((4, 2))), "joints: has the shape"),
                ((position, quaternion[:3], np.zeros((4, 0))), "root_quaternions: has the shape"),
                ((position[:, :2], quaternion, np.zeros((4, 0))), "root_positions: has the shape"),
                ((position, 2 * quaternion, np.zeros((4, 0))), "must have the length 1"),
                ((position, quaternion, np.zeros((4, 1)), ["Knee"]), "has no joint \"Knee\"")):
            with self.assertRaisesRegex(mmmconverter.Error, message):
                model.forward(*arguments)
        with self.assertRaises(mmmconverter.Error):
            mmmconverter.read_model("no_such.xml")

    def test_what_a_model_says(self):
        model = mmmconverter.read_model(height=1.75)
        self.assertEqual(model.limits.shape, (len(model.joint_names), 2))
        self.assertTrue((model.limits[:, 0] < model.limits[:, 1]).all())
        self.assertIn("LWx_joint", model.segments)
        self.assertEqual(len(model.parents), len(model.segments))
        self.assertEqual(model.parents[0], -1)
        self.assertTrue(all(parent < i for i, parent in enumerate(model.parents)))
        self.assertIn("height 1.75 m", repr(model))
        self.assertIn("<table>", model._repr_html_())
        self.assertIn("not scaled", repr(mmmconverter.read_model()))

    def test_forward_is_what_the_program_exports(self):
        self.run_program("convert", SAMPLE, "--height", "1.8", "--frames", ":40", "-o",
                         self.folder / "m.xml", "--export-poses", self.folder / "m.npz")
        exported = np.load(self.folder / "m.npz")
        result = mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 40))
        poses = result.model.forward(result)
        self.assertEqual(list(exported["segments"]), result.model.segments)
        np.testing.assert_array_equal(poses.positions, exported["segment_positions"])

    def test_markers_alone_are_the_same(self):
        model = mmmconverter.read_model(height=1.75)
        motion = mmmconverter.read_motion(ROOT / "examples/handstand_true.xml")
        np.testing.assert_allclose(model.place_markers(motion), model.forward(motion).markers,
                                   rtol=0, atol=1e-12)
        frames = 20000
        postures = (np.zeros((frames, 3)), np.tile([1.0, 0, 0, 0], (frames, 1)),
                    np.zeros((frames, len(model.joint_names))))
        for compute in (model.place_markers, model.forward):
            began = time.perf_counter()
            compute(*postures)
            seconds = time.perf_counter() - began
            print(f"{compute.__name__}: {60e-6 * frames / seconds:.1f} million postures a minute")
        one = model.place_markers([0, 0, 1], [1, 0, 0, 0])
        np.testing.assert_allclose(one, model.forward([0, 0, 1], [1, 0, 0, 0]).markers, atol=1e-12)

    def test_a_tracker_is_the_conversion(self):
        recording = mmmconverter.read(SAMPLE)
        result = mmmconverter.convert(recording, height=1.8, config="jacobian_pull", frames=(0, 60))
        tracker = mmmconverter.Tracker(mmmconverter.read_model(height=1.8), recording.labels,
                                       "jacobian_pull")
        self.assertEqual(tracker.joint_names, result.joint_names)
        self.assertEqual(tracker.marker_labels, result.marker_labels)
        for k in range(60):
            frame = recording.markers[k]
            estimate = tracker.assemble(frame) if k == 0 else tracker.track(frame, 0.01)
            np.testing.assert_array_equal(estimate.joints, result.joints[k])
            np.testing.assert_array_equal(estimate.root_position, result.root_positions[k])
            np.testing.assert_array_equal(estimate.root_quaternion, result.root_quaternions[k])
            np.testing.assert_array_equal(estimate.residuals, result.residuals[k])
        self.assertIn("markers seen 53", repr(estimate))
        self.assertIn("joints 44", repr(tracker))
        poses = mmmconverter.read_model(height=1.8).forward(estimate)
        np.testing.assert_array_equal(poses.positions[0], estimate.root_position)

    def test_a_tracker_goes_on_without_markers(self):
        recording = mmmconverter.read(SAMPLE)
        tracker = mmmconverter.Tracker(mmmconverter.read_model(height=1.8), recording.labels)
        with self.assertRaisesRegex(mmmconverter.Error, "assemble"):
            tracker.track(recording.markers[0], 0.01)
        tracker.assemble(recording.markers[0])
        estimate = tracker.track(np.full((53, 3), np.nan), 0.01)
        self.assertEqual(estimate.markers_seen, 0)
        self.assertTrue(np.isfinite(estimate.joints).all())
        self.assertEqual(estimate.sd.shape, (50,))
        with self.assertRaisesRegex(mmmconverter.Error, "frame: has the shape"):
            tracker.track(np.zeros((3, 53)), 0.01)
        with self.assertRaisesRegex(mmmconverter.Error, "dt: "):
            tracker.track(recording.markers[1], 0)

    def test_a_tracker_understands_names(self):
        names = {"FHD": "HDF", "BHD": "HDB", "SHO": "SAJ", "AEL": "HLE", "WTS": "RSP", "WPS": "USP",
                 "ASI": "IAS", "PSI": "IPS", "HIP": "FTC", "KNE": "FLE", "ANK": "FAL", "HEE": "FCC",
                 "MT1": "FM1", "MT5": "FM5"}
        recording = mmmconverter.read(SAMPLE)
        columns = [i for i, label in enumerate(recording.labels) if label[1:] in names]
        labels = [recording.labels[i] for i in columns]
        renamed = [f"{label[0]}_{names[label[1:]]}" for label in labels]
        model = mmmconverter.read_model(height=1.8)
        frame = recording.markers[0][columns]
        by_names = mmmconverter.Tracker(model, renamed).assemble(frame)
        self.assertEqual(by_names.markers_seen, len(renamed))
        by_set = mmmconverter.Tracker(model, labels).assemble(frame)
        np.testing.assert_allclose(by_names.root_position, by_set.root_position, atol=0.03)  # the sets have other places

    def test_live_postures_are_those_of_a_conversion(self):
        result = mmmconverter.convert(SAMPLE, height=1.8)
        with mmmconverter.live(f"replay:{SAMPLE}@max", height=1.8) as stream:
            postures = list(stream)
        np.testing.assert_array_equal([one.joints for one in postures], result.joints)
        np.testing.assert_array_equal([one.root_quaternion for one in postures], result.root_quaternions)
        np.testing.assert_allclose([one.time for one in postures], result.times, atol=1e-12)
        self.assertEqual((stream.frames, stream.dropped, postures[5].stage), (675, 0, "tracking"))
        body = postures[0].body
        self.assertIs(postures[-1].body, body)
        np.testing.assert_array_equal(postures[9].markers, mmmconverter.read(SAMPLE).markers[9])
        self.assertEqual((body.model.height, body.is_calibrated), (1.8, False))
        np.testing.assert_array_equal(body.model.forward(postures[0]).positions[0], postures[0].root_position)
        self.assertEqual(len(body.marker_labels), len(postures[0].residuals))
        self.assertTrue(any("53 labels" in text for text in stream.messages), stream.messages)
        self.assertIn("frames 675", repr(stream))

    def test_live_ends_where_its_caller_does(self):
        def count_threads():
            gc.collect()
            return len(os.listdir("/proc/self/task"))

        def check_threads():  # one that was joined leaves /proc a little later
            end = time.monotonic() + 10
            while count_threads() > before and time.monotonic() < end:
                pass
            self.assertLessEqual(count_threads(), before)

        before = count_threads()
        for posture in mmmconverter.live(f"replay:{SAMPLE}", loop=True, height=1.8):
            break
        check_threads()
        stream = mmmconverter.live(f"replay:{SAMPLE}@max", height=1.8)
        with self.assertRaises(ZeroDivisionError), stream:
            for posture in stream:
                1 / 0
        self.assertEqual(list(stream), [])
        check_threads()
        # While it waits for a frame.
        waiting = mmmconverter.live(f"replay:{SAMPLE}@0.001", height=1.8)
        next(waiting)
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            timer.start()
            list(waiting)
        timer.join()
        self.assertEqual(list(waiting), [])
        check_threads()
        waiting.close()
        self.assertLess(len(list(mmmconverter.live(f"replay:{SAMPLE}", loop=True, height=1.8, seconds=0.2))), 675)

    def test_live_tracks_a_rigid_object(self):
        places = np.array([[0, 0.02, 0], [0.16, -0.01, 0.03], [0.01, 0.09, 0.05], [-0.05, 0, 0.12]])
        way = np.linspace(0, 1, 40)[:, np.newaxis, np.newaxis] * [0.5, 1, 0.2]
        box = mmmconverter.Recording.from_arrays(["1", "2", "3", "4"], places + way, 100)
        box.save(self.folder / "box.c3d")
        self.run_program("convert", self.folder / "box.c3d", "--object", "--object-models", self.folder / "objects",
                         "-o", self.folder / "box.xml")
        converted, = mmmconverter.read_motions(self.folder / "box.xml")
        source = f"replay:{self.folder / 'box.c3d'}@max"
        model = self.folder / "objects/box.xml"
        postures = list(mmmconverter.live(source, model=model))
        np.testing.assert_allclose([one.root_position for one in postures], converted.root_positions, atol=1e-6)
        self.assertEqual(postures[0].joint_names, [])
        with self.assertRaisesRegex(mmmconverter.Error, "tracked as a rigid object; height"):
            list(mmmconverter.live(source, model=model, height=1.8))

    def test_live_tracks_several_objects(self):
        places = np.array([[0, 0.02, 0], [0.16, -0.01, 0.03], [0.01, 0.09, 0.05], [-0.05, 0, 0.12]])
        way = np.linspace(0, 1, 40)[:, np.newaxis, np.newaxis] * [0.5, 1, 0.2]
        shapes = {"box": places, "lamp": 1.5 * places[::-1] + [1, 0, 0]}
        for name, shape in shapes.items():
            one = mmmconverter.Recording.from_arrays(["1", "2", "3", "4"], shape + way, 100)
            one.save(self.folder / f"{name}.c3d")
            self.run_program("convert", self.folder / f"{name}.c3d", "--object", "--object-models", self.folder / "several",
                             "-o", self.folder / f"{name}.xml")
        labels = [f"{name}:{i}" for name in shapes for i in (1, 2, 3, 4)]
        both = np.concatenate([shape + way for shape in shapes.values()], axis=1)
        mmmconverter.Recording.from_arrays(labels, both, 100).save(self.folder / "both.c3d")
        box, lamp = (self.folder / "several" / f"{name}.xml" for name in shapes)
        postures = list(mmmconverter.live(f"replay:{self.folder / 'both.c3d'}@max", model=box, and_models=[lamp]))
        self.assertEqual([one.body.name for one in postures[:4]], ["box", "lamp", "box", "lamp"])
        for name in shapes:
            converted, = mmmconverter.read_motions(self.folder / f"{name}.xml")
            found = [one.root_position for one in postures if one.body.name == name]
            np.testing.assert_allclose(found, converted.root_positions, atol=1e-6)

    def test_live_says_what_is_wrong(self):
        for source, options, error in ((SAMPLE, {}, "qtm"), ("replay:none.c3d", {}, "no such file"),
                                       (f"replay:{SAMPLE}@max", {"height": 9.0}, "height"),
                                       (f"replay:{SAMPLE}", {"seconds": -1}, "seconds"),
                                       (f"replay:{SAMPLE}", {"calibrate_seconds": 5}, "self_calibrate")):
            with self.subTest(source, **options), self.assertRaisesRegex(mmmconverter.Error, error):
                mmmconverter.live(source, **options)
        for option in ({"frames": (0, 5)}, {"format": "1.0"}):
            with self.assertRaises(TypeError):
                mmmconverter.live(f"replay:{SAMPLE}", **option)
        model = ROOT / "examples/robot/biped.urdf"
        with self.assertRaises(mmmconverter.Error):
            next(mmmconverter.live(f"replay:{SAMPLE}@max", model=model))

    def test_threads_have_a_tracker_each(self):
        recording = mmmconverter.read(SAMPLE)
        model = mmmconverter.read_model(height=1.8)
        last = {}

        def work(name):
            tracker = mmmconverter.Tracker(model, recording.labels)
            estimate = tracker.assemble(recording.markers[0])
            for frame in recording.markers[1:50]:
                estimate = tracker.track(frame, 0.01)
            last[name] = estimate.joints

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(last[0], last[1])


if __name__ == "__main__":
    unittest.main()
