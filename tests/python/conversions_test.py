# SPDX-License-Identifier: MIT
"""Conversions beside those of the program, to the last bit."""
import concurrent.futures
import copy
import json
import multiprocessing
import os
import pathlib
import signal
import threading
import unittest

import numpy as np

import mmmconverter
from support import Case, SAMPLE, run_program


def without_times(summary):
    """What two runs have alike."""
    summary = json.loads(json.dumps(summary))
    for name in ("ms_per_frame", "output", "seconds"):
        summary.pop(name, None)
    return summary


def convert_part(frames):
    return mmmconverter.convert(SAMPLE, height=1.8, frames=frames, progress=False)


class Conversions(Case):

    def expect_the_programs(self, file, options, **keywords):
        """Converts in both ways. Returns Python's."""
        motion, csv, npz = (self.folder / f"program.{name}" for name in ("xml", "csv", "npz"))
        centres = self.folder / "holosoma.npz"
        self.run_program("convert", file, "-o", motion, "--export-csv", csv, "--export-poses", npz, "--export-holosoma",
                         centres, "--summary", self.folder / "program.json", *options)
        result = mmmconverter.convert(file, **keywords)
        for theirs in (motion, csv, npz):
            ours = self.folder / f"python{theirs.suffix}"
            result.save(ours)
            self.assert_same_files(ours, theirs)
        summary = json.loads((self.folder / "program.json").read_text())
        self.assertEqual(without_times(result.summary), without_times(summary))
        self.assertEqual(result.verdict, summary["verdict"]["level"])
        # All digits of what the program computed.
        poses = np.load(npz)
        root = list(poses["segments"]).index("root_joint")
        np.testing.assert_array_equal(result.root_positions, poses["segment_positions"][:, root])
        np.testing.assert_array_equal(result.times, poses["time"])
        human = np.load(centres)
        hips = [human["global_joint_positions"][0, list(human["joint_names"]).index(name)] for name in ("L_Hip", "R_Hip")]
        for place, joint in zip(hips, ("LHx_joint", "RHx_joint")):
            segment = list(poses["segments"]).index(joint)
            np.testing.assert_allclose(place, poses["segment_positions"][0, segment], atol=1e-12)
        forward = result.model.forward(result)
        np.testing.assert_array_equal(forward.positions, poses["segment_positions"])
        return result

    def test_the_sample(self):
        result = self.expect_the_programs(SAMPLE, ["--height", "1.8"], height=1.8)
        self.assertEqual(result.joints.shape, (675, 44))
        self.assertEqual(result.sd.shape, (675, 50))
        self.assertIsNone(result.velocities)
        self.assertEqual(result.residuals.shape, (675, 53))
        self.assertEqual(len(result.marker_labels), 53)
        self.assertEqual(result.frames["markers_seen"].tolist(), [53] * 675)
        self.assertIn("verdict check", repr(result))
        self.assertEqual((len(result.reasons), result.rate), (1, 100))
        self.assertEqual(result.warnings, result.summary["warnings"])
        self.assertIn("verdict", result._repr_html_())
        self.assertIn("handstand.c3d", result.text)

    def test_joints_in_arrays_of_numpy(self):
        places = np.load(pathlib.Path(__file__).parents[1] / "fuzz/corpus/npz-read-places.npy").astype(float)
        for save in (np.savez, np.savez_compressed):
            save(self.folder / "joints.npz", global_joint_positions=np.asfortranarray(places), fps=30)
            read = mmmconverter.read(self.folder / "joints.npz", up="z")
            self.assertEqual((read.format, read.labels[0], read.rate, read.unit), ("joint places", "Pelvis", 30, "m"))
            np.testing.assert_allclose(read.markers, places, atol=1e-12)

    def test_angles_by_their_names(self):
        table = self.folder / "angles.csv"
        self.run_program("convert", SAMPLE, "--height", "1.8", "-o", self.folder / "m.xml", "--export-angles", table)
        angles = mmmconverter.convert(SAMPLE, height=1.8).angles
        rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
        names = [" ".join(filter(None, (row[2], row[1], row[3]))) for row in rows]
        own_sides = ("left pelvis", "right pelvis", "left trunk", "right trunk", "left neck", "right neck")
        rows = [row for row, name in zip(rows, names) if not name.startswith(own_sides)]
        self.assertEqual([name for name in names if not name.startswith(own_sides)][:len(angles.names)], angles.names)
        figures = np.array([[float(row[4]), float(row[5])] for row in rows]).reshape(675, len(angles.names), 2)
        np.testing.assert_allclose(angles.values, figures[..., 0], atol=1e-6)
        np.testing.assert_allclose(angles.sd, figures[..., 1], atol=1e-6)
        np.testing.assert_array_equal(angles["left knee flexion"],
                                      angles.values[:, angles.names.index("left knee flexion")])
        with self.assertRaisesRegex(KeyError, "left knee flexion"):
            angles["knee"]
        import matplotlib
        matplotlib.use("Agg")
        axes = angles.plot("knee flexion")
        self.assertEqual([line.get_label() for line in axes.get_lines()], ["left", "right"])
        np.testing.assert_array_equal(axes.get_lines()[0].get_ydata(), angles["left knee flexion"])

    def test_comes_back_from_a_process_pool(self):
        with concurrent.futures.ProcessPoolExecutor(4, multiprocessing.get_context("spawn")) as pool:
            results = list(pool.map(convert_part, [(0, 20), (20, 40), (40, 60), (60, 80)]))
        whole = mmmconverter.convert(SAMPLE, height=1.8, frames=range(0, 20), progress=False)
        for name in ("joints", "sd", "root_positions", "residuals", "times"):
            np.testing.assert_array_equal(getattr(results[0], name), getattr(whole, name))
        self.assertEqual(results[0].angles.names, whole.angles.names)
        self.assertEqual([len(one) for one in results], [20] * 4)
        again = copy.deepcopy(whole)
        np.testing.assert_array_equal(again.joints, whole.joints)
        with self.assertRaisesRegex(mmmconverter.Error, "before it is copied"):
            again.save(self.folder / "copy.xml")

    def test_errors_are_pythons(self):
        recording = mmmconverter.read(SAMPLE)
        for wrong, error, words in (
                (lambda: mmmconverter.convert(self.folder / "absent.c3d"), FileNotFoundError, "no such file"),
                (lambda: mmmconverter.read(self.folder / "absent.c3d"), FileNotFoundError, "no such file"),
                (lambda: mmmconverter.convert(recording, unit="mm"), ValueError, "give it to read"),
                (lambda: mmmconverter.convert(SAMPLE, heigth=1), TypeError, r"convert\(\).*'heigth'.*'height'"),
                (lambda: mmmconverter.convert(SAMPLE, height=[1]), TypeError, r"height: \[1\].*float"),
                (lambda: mmmconverter.convert(SAMPLE, frames=range(0, 20, 2)), ValueError, "without a step"),
                (lambda: mmmconverter.Recording.from_arrays(["a", "b"], 1000 * np.arange(6).reshape(1, 2, 3), 100),
                 ValueError, "millimetres")):
            with self.assertRaisesRegex(error, words):
                wrong()
        result = mmmconverter.convert(recording, height=1.8, frames=slice(0, 5), progress=False)
        with self.assertRaisesRegex(ValueError, r"\.xlsx: no motion.*\.xml"):
            result.save(self.folder / "motion.xlsx")
        self.assertFalse((self.folder / "motion.xlsx").exists())
        self.assertLessEqual({"verdict", "joints", "angles"}, set(dir(result)))
        self.assertLessEqual({"labels", "markers"}, set(dir(recording)))

    def test_smoothed_and_of_a_part(self):
        result = self.expect_the_programs(
            SAMPLE, ["--height", "1.8", "--mass", "80", "-c", "s2kf_offline", "--frames", "100:220"],
            height=1.8, mass=80, config="s2kf_offline", frames=(100, 220))
        self.assertEqual(result.velocities.shape, (120, 50))
        self.assertEqual(result.accelerations.shape, (120, 50))
        self.assertAlmostEqual(result.times[0], 1)

    def test_covariances(self):
        for config in ("s2kf_default", "s2kf_offline"):
            with self.subTest(config=config):
                npz = self.folder / "program.npz"
                self.run_program("convert", SAMPLE, "-o", self.folder / "m.xml", "--height", "1.8",
                                 "--frames", "100:160", "-c", config, "--export-covariance", npz)
                result = mmmconverter.convert(SAMPLE, height=1.8, frames=(100, 160), config=config,
                                              covariances=True)
                frames, covariances = result.covariances
                arrays = np.load(npz)
                np.testing.assert_array_equal(arrays["covariance"], covariances)
                np.testing.assert_array_equal(arrays["frame"], frames)
                np.testing.assert_array_equal(arrays["time"], result.times[frames])
                self.assertEqual(list(arrays["names"][6:]), result.joint_names)
                self.assertEqual(covariances.shape, (len(frames), 50, 50))
                self.assertGreater(len(frames), 5)
                np.testing.assert_allclose(np.sqrt(np.diagonal(covariances, axis1=1, axis2=2)),
                                           result.sd[frames], rtol=1e-9)
                self.assertGreater(np.linalg.eigvalsh(covariances).min(), 0)
        self.assertIsNone(mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 10)).covariances)
        with self.assertRaisesRegex(mmmconverter.Error, "JacobianConverter estimates no covariances"):
            mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 10), config="jacobian_pull",
                                 covariances=True)

    def test_calibrated_on_itself(self):
        self.expect_the_programs(
            SAMPLE, ["--height", "1.8", "--self-calibrate", "--frames", ":200", "-c", "jacobian_pull"],
            height=1.8, self_calibrate=True, frames=(None, 200), config="jacobian_pull")

    def test_a_recording_is_read_once(self):
        recording = mmmconverter.read(SAMPLE)
        of_recording = mmmconverter.convert(recording, height=1.8, frames=(0, 40))
        of_file = mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 40))
        of_arrays = mmmconverter.convert(
            mmmconverter.Recording.from_arrays(recording.labels, recording.markers[:40], 100,
                                               recording.first_time), height=1.8)
        for other in (of_file, of_arrays):
            np.testing.assert_array_equal(of_recording.joints, other.joints)
            np.testing.assert_array_equal(of_recording.root_quaternions, other.root_quaternions)
            np.testing.assert_array_equal(of_recording.sd, other.sd)

    def test_two_threads_give_the_same(self):
        recording = mmmconverter.read(SAMPLE)
        results = [None, None]

        def work(i):
            results[i] = mmmconverter.convert(recording, height=1.8, frames=(0, 150))

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(results[0].joints, results[1].joints)

    def test_progress_is_said_and_can_end_the_work(self):
        said = []
        mmmconverter.convert(SAMPLE, height=1.8, progress=lambda done, all: said.append((done, all)))
        self.assertEqual(said[-1], (675, 675))

        def stop(done, all):
            raise RuntimeError(f"enough at {done}")

        with self.assertRaisesRegex(RuntimeError, "enough at"):
            mmmconverter.convert(SAMPLE, height=1.8, progress=stop)

    def test_ctrl_c_ends_the_work(self):
        def interrupt(done, all):
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            for _ in range(1000):  # what is shorter than a look for signals ends by itself
                mmmconverter.convert(SAMPLE, height=1.8, progress=interrupt)

    def test_errors_have_the_programs_text(self):
        for options, keywords in (
                (["--frames", "700:800"], {"frames": (700, 800)}),
                (["-c", "no_such"], {"config": "no_such"}),
                (["--model", "no_such.xml"], {"model": "no_such.xml"})):
            with self.subTest(**keywords):
                run = run_program("convert", SAMPLE, "-o", self.folder / "m.xml", *options)
                with self.assertRaises(mmmconverter.Error) as raised:
                    mmmconverter.convert(SAMPLE, **keywords)
                text = run.stderr.strip().replace("--", "")  # of options
                self.assertEqual(text, f"error: {raised.exception}")
        with self.assertRaisesRegex(mmmconverter.Error,
                                    "^height: 18 is not allowed; give metres from 0.5 to 2.5$"):
            mmmconverter.convert(SAMPLE, height=18)
        with self.assertRaisesRegex(mmmconverter.Error, "format: "):
            mmmconverter.convert(SAMPLE, height=1.8, format="3.0")
        with self.assertRaises(TypeError):
            mmmconverter.convert(SAMPLE, heigth=1.8)

    def test_no_recording_is_overwritten(self):
        recording = mmmconverter.read(SAMPLE)
        copy = self.folder / "walk.c3d"
        recording.save(copy)
        with self.assertRaisesRegex(ValueError, "x.foo: no recording is written so"):
            recording.save(self.folder / "x.foo")
        recording.save(self.folder / "x.trc")
        self.assertEqual(mmmconverter.read(self.folder / "x.trc").format, "TRC")
        before = copy.read_bytes()
        result = mmmconverter.convert(copy, height=1.8, frames=(0, 20))
        for write in (result.save, result.report):
            with self.assertRaises(mmmconverter.Error):
                write(copy)
        with self.assertRaises(mmmconverter.Error):
            result.save(self.folder / "absent" / "m.xml")
        self.assertEqual(copy.read_bytes(), before)

    def test_files_for_other_programs(self):
        result = mmmconverter.convert(SAMPLE, height=1.8, frames=(0, 20))
        for name, start in (("o.trc", b"PathFileType"), ("o.mot", b"Coordinates"),
                            ("o.bvh", b"HIERARCHY"), ("o.NPZ", b"PK")):
            result.save(self.folder / name)
            self.assertTrue((self.folder / name).read_bytes().startswith(start), name)
        result.report(self.folder / "o.html")
        self.assertIn(b"</html>", (self.folder / "o.html").read_bytes())

    def test_incidents_name_markers(self):
        markers = np.array(mmmconverter.read(SAMPLE).markers[:100])
        markers[50:, 10] += 1.0
        recording = mmmconverter.Recording.from_arrays(mmmconverter.read(SAMPLE).labels, markers, 100)
        result = mmmconverter.convert(recording, height=1.8)
        incident = result.incidents[0]
        self.assertEqual(incident["kind"], "misplaced")
        self.assertEqual(incident["marker"], recording.labels[10])
        self.assertEqual(incident["first_frame"], 50)


if __name__ == "__main__":
    unittest.main()
