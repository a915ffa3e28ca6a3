# SPDX-License-Identifier: MIT
"""What needs real files: read, converted and exported."""
import os
import unittest

import numpy as np

import conversions_test
import mmm_chain
import mmmconverter
import poses_test
from support import Case, SHARED


class RealRecordings(Case):

    def test_analog_samples_are_the_forces_that_another_program_read(self):
        recording = mmmconverter.read(SHARED / "forces/walking2.c3d")
        analog = recording.analog
        self.assertEqual((analog["rate"], analog["labels"][2], analog["units"][2]), (2000, "Fz1", "N"))
        self.assertEqual(analog["samples"].shape, (8 * len(recording), 12))
        # BTK's, 20 a second, as OpenSim has them: what acts on the person, in the world's axes.
        text = (SHARED / "forces/std_cop_walking2_grfs.sto").read_text().split("endheader")[1]
        there = np.array([line.split() for line in text.strip().splitlines()[1:]], float)
        here = analog["samples"][::100]
        rows = min(len(there), len(here))
        self.assertGreater(rows, 50)
        for column, sign, channel in ((1, -1, "Fy1"), (2, -1, "Fx1"), (3, -1, "Fz1"),
                                      (10, -1, "Fx2"), (11, 1, "Fy2"), (12, -1, "Fz2")):
            # Eight decimals are written.
            np.testing.assert_allclose(sign * here[:rows, analog["labels"].index(channel)],
                                       there[:rows, column], atol=1e-8)

    def test_force_plates_lie_where_the_markers_are(self):
        plates = mmmconverter.read(SHARED / "forces/walking2.c3d").force_plates
        self.assertEqual([plate["type"] for plate in plates], [2, 2])
        np.testing.assert_array_equal(plates[1]["channels"], range(6, 12))
        # What the file says in millimetres, z up.
        np.testing.assert_allclose(
            plates[0]["corners"], [[0.6646, 0.37932, 0], [0.6646, 0.84287, 0],
                                   [1.1726, 0.84287, 0], [1.1726, 0.37932, 0]], atol=1e-7)
        np.testing.assert_allclose(plates[1]["origin"], [0, 0, 0.05715], atol=1e-7)

    def test_strides_of_two_trials(self):
        results = [mmmconverter.convert(SHARED / f"reports/{name}.c3d", progress=False)
                   for name in ("f_base_type2", "w_treadmill_2800ms")]
        strides = mmmconverter.strides(results)
        self.assertEqual(set(strides.trials), {"f_base_type2", "w_treadmill_2800ms"})
        knee = strides["left knee flexion"]
        self.assertEqual(knee.shape, (strides.sides.count("left"), 101))
        self.assertGreater(knee.mean(axis=0).max(), 40)
        ground = results[0].ground
        self.assertEqual(ground.kind, "walking")
        self.assertAlmostEqual(ground.mass["kg"], 70, delta=0.7)
        try:
            import pandas  # noqa: F401
        except ImportError:
            return
        self.assertAlmostEqual(ground.parameters["left mean"]["stride_length_m"], 1.2, delta=0.02)
        self.assertIn("left ankle power [W/kg]", ground.powers.columns)
        self.assertIn("left knee extension moment [N m/kg]", ground.moments.columns)
        self.assertEqual(list(ground.loads["foot"]), ["left", "right"])
        self.assertEqual(set(ground.contacts["foot"]), {"left", "right"})
        self.assertIn("left knee flexion [deg]", ground.cycles.columns)
        self.assertTrue(ground.work.empty)  # no foot is on plates over a whole stride
        self.assertTrue(ground.emg.empty)
        muscles = mmmconverter.convert(SHARED / "field/btk_FunctionalWalk.c3d", emg="EMG3", progress=False).ground.emg
        self.assertEqual(list(muscles.columns), ["left EMG3 EMG [mV]", "right EMG3 EMG [mV]"])
        self.assertTrue((muscles > 0).all().all())
        self.assertEqual(len(strides.to_dataframe()), len(strides))

    def test_forces_are_what_opensim_stored(self):
        recording = mmmconverter.read(SHARED / "forces/walking2.c3d")
        forces = recording.forces
        self.assertEqual((forces["rate"], forces["samples_per_frame"]), (2000, 8))
        text = (SHARED / "forces/std_cop_walking2_grfs.sto").read_text().split("endheader")[1]
        stored = np.array([line.split() for line in text.strip().splitlines()[1:]], float)
        samples = np.rint(2000 * stored[:, 0]).astype(int)
        for i, plate in enumerate(forces["plates"]):
            there = stored[:, 1 + 9 * i:10 + 9 * i]
            np.testing.assert_allclose(plate["force"][samples], there[:, :3], atol=1e-3)
            loaded = there[:, 2] > 20
            self.assertTrue(loaded.any())
            np.testing.assert_allclose(1e3 * plate["center_of_pressure"][samples][loaded],
                                       there[loaded, 3:6], atol=1e-2)
            np.testing.assert_allclose(1e3 * plate["free_moment"][samples][loaded],
                                       there[loaded, 6:], atol=1e-2)
            arm = plate["center_of_pressure"] - plate["center"]
            np.testing.assert_allclose(
                (np.cross(arm, plate["force"]) + plate["free_moment"])[samples][loaded],
                plate["moment"][samples][loaded], atol=1e-9)
        np.testing.assert_allclose(forces["plates"][1]["loads"], [[2.2475, 2.7595]], atol=1e-3)
        # One for each frame.
        self.assertEqual(len(forces["plates"][0]["force"][::8]), len(recording))

    def test_events_of_a_file(self):
        before = os.getcwd()
        os.chdir(SHARED)
        try:
            recording = mmmconverter.read("recordings/conformance/Eb015pr.c3d")
        finally:
            os.chdir(before)
        self.assertEqual(len(recording.events), 3)  # wherever the program is by now
        for event in recording.events:
            self.assertGreaterEqual(event["time"], 0)
            self.assertEqual(set(event), {"time", "label", "context", "subject"})

    def test_motions_of_a_file(self):
        file = SHARED / "mmm/kit_bimanual_10hz/Close_files_motions_3072_Close1_aj_180_30h_08.xml"
        motions = mmmconverter.read_motions(file)
        self.assertEqual([one.name for one in motions][3:5], ["true_1723", "pred_1723"])
        with self.assertRaisesRegex(mmmconverter.Error, "true_apple_juice"):
            mmmconverter.read_motion(file)
        motion = mmmconverter.read_motion(file, "true_1723")
        frames = len(motion.times)
        self.assertEqual(motion.joints.shape, (frames, len(motion.joint_names)))
        self.assertEqual(motion.root_quaternions.shape, (frames, 4))
        np.testing.assert_allclose(np.linalg.norm(motion.root_quaternions, axis=1), 1)
        self.assertGreater(len(motion.labels), 3)
        self.assertEqual(motion.markers.shape[1:], (len(motion.labels), 3))


class RealConversions(Case):

    expect_the_programs = conversions_test.Conversions.expect_the_programs

    def test_real_recordings(self):
        for file, height in (("kit_bimanual_c3d/Close_1723.c3d", 1.68),
                             ("kit_bimanual_c3d/Pour_1480.c3d", 1.75),
                             ("whole_body/cmu_02_05.c3d", 1.75),
                             ("whole_body/pycgm_movement_trial.c3d", 1.8)):
            with self.subTest(file=file):
                self.expect_the_programs(
                    SHARED / "recordings" / file, ["--height", str(height), "--frames", ":80"],
                    height=height, frames=(None, 80))


class RealPoses(Case):

    export = poses_test.Poses.export
    expect_points = poses_test.Poses.expect_points

    def test_joints_of_kits_motions(self):
        model = SHARED / "mmm/models/mmm_v2.2_133nodes_53markers.xml"
        for file, read in (
                ("motions_legacy/walking_medium01_motion395.xml", mmm_chain.read_legacy),
                ("motions_mmm2/wave_left01.xml", mmm_chain.read_sensors)):
            with self.subTest(file=file):
                height, frames = read(SHARED / "mmm" / file)
                poses = self.export(SHARED / "mmm" / file, "--model", model)
                # A millimetre is what is asked for; the numbers are the file's.
                self.expect_points(poses, mmm_chain.Chain(model, height), frames, 1e-6)

    def test_objects_stand_beside_the_person(self):
        file = SHARED / "mmm/kit_bimanual_10hz/Close_files_motions_3072_Close1_aj_180_30h_08.xml"
        poses = self.export(file, "--motion", "true_1723", "--relative-to", "root")
        self.assertIn("true_apple_juice", poses["objects"])
        self.assertEqual(poses["object_positions"].shape, (len(poses["time"]), 5, 3))
        self.assertEqual(str(poses["frame"]), "root")
        np.testing.assert_array_equal(poses["segment_positions"][:, 0], 0)


if __name__ == "__main__":
    if SHARED.exists():
        unittest.main()
    print(f"Skipped: needs the real files in {SHARED}")
