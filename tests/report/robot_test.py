# SPDX-License-Identifier: MIT
"""robot_test.py FOLDER [unittest arguments]: the page of a handstand on examples/robot/biped.urdf in a real browser."""

import math

from page_case import PageCase, run_tests

PERSON, ROBOT = 0, 1


class Scene(PageCase):
    webgl = True

    def setUp(self):
        super().setUp()
        self.open("robot.html")

    def middles(self, body):
        """Where the parts of a body are drawn, by name."""
        parts = {}
        for one in self.run_script("return mmmReport.places(arguments[0])", body):
            parts.setdefault(one["part"], []).append(one["place"])
        return {name: [sum(axis) / len(places) for axis in zip(*places)] for name, places in parts.items()}

    def test_each_limb_is_beside_the_persons(self):
        for frame in (0, 150, 230, 339):
            self.run_script("mmmReport.seek(arguments[0])", frame)
            person, robot = self.middles(PERSON), self.middles(ROBOT)
            self.assertEqual(set(person), set(robot))
            for part in ("left foot", "right foot"):
                other = part.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right")
                self.assertLess(math.dist(robot[part], person[part]), 0.2, (frame, part))
                if frame == 230:  # one leg is up
                    self.assertLess(math.dist(robot[part], person[part]), math.dist(robot[part], person[other]))

    def test_zero_poses(self):
        self.assertIn("<script>window.hacked=1</script>", self.text("#stage-names"))
        self.run_script("mmmReport.showTrial(1)")
        places = {one["name"]: one for one in self.run_script("return mmmReport.places(1)")}
        for side, y in (("left", 0.1), ("right", -0.1)):
            for value, wanted in zip(places[f"{side}_hip_pitch"]["place"], (0, y, 0.8)):
                self.assertAlmostEqual(value, wanted, places=3)
            self.assertEqual(places[f"{side}_knee"]["part"], f"{side} leg")
            self.assertEqual(places[f"{side}_ankle_pitch"]["part"], f"{side} leg")
            self.assertEqual(places[f"{side}_ankle_roll"]["part"], f"{side} foot")
        self.assertGreater(self.middles(PERSON)["left foot"][1], self.middles(PERSON)["right foot"][1])
        self.assertAlmostEqual(self.middles(PERSON)["left leg"][1], -self.middles(PERSON)["right leg"][1], places=3)
        self.assertFalse(self.find("#feet-part").is_displayed())

    def test_feet_that_stand_have_another_colour(self):
        colours = [self.run_script("return mmmReport.colours(arguments[0])", body) for body in (PERSON, ROBOT)]
        self.assertEqual(colours[PERSON], colours[ROBOT])
        self.assertIn("left foot on heel and toe", self.text("#now"))
        self.assertEqual(colours[ROBOT]["left foot"], colours[ROBOT]["right foot"])
        self.run_script("mmmReport.seek(339)")
        self.assertIn("left foot in the air", self.text("#now"))
        in_air = self.run_script("return mmmReport.colours(1)")
        for side in ("left", "right"):
            self.assertEqual(in_air[f"{side} foot"], in_air[f"{side} leg"])
            self.assertNotEqual(colours[ROBOT][f"{side} foot"], in_air[f"{side} foot"])


class RobotPage(PageCase):

    def setUp(self):
        super().setUp()
        self.open("robot.html")

    def test_times_and_joints_can_be_chosen(self):
        figures = self.run_script("return mmmReport.figures")
        self.assertEqual(len(self.texts("#limbs tbody tr")), len(figures["limbs"]))
        self.click("#limbs tbody tr:first-child button")
        at = round(figures["limbs"][0]["most_at_s"] * figures["rate_hz"])
        self.assertEqual(self.run_script("return mmmReport.frame"), at)
        self.assertEqual(self.texts("#joint-charts h3"), ["left_knee, right_knee"])
        self.run_script("document.querySelector('[data-joint=ankle]').dispatchEvent(new MouseEvent('click'))")
        self.assertEqual(self.texts("#joint-charts h3"),
                         ["left_ankle_pitch, right_ankle_pitch", "left_ankle_roll, right_ankle_roll"])
        shown = self.text("#figures")
        self.assertIn(f"{100 * figures['slide']:.1f} %", shown)
        self.assertIn(f"{math.degrees(figures['direction_rad']):.1f}°", shown)

    def test_names_of_the_robot_stay_text(self):
        self.assertIn("<script>window.hacked=1</script>", self.text("#map"))
        self.check_nothing_was_run()
        self.check_nothing_was_loaded()
        self.check_fits(["robot.html"])
        self.check_injected_scripts_do_not_run("robot.html")


if __name__ == "__main__":
    run_tests()
