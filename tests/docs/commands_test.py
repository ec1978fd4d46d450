#!/usr/bin/env python3
"""What a page says wrongly is found: the test of commands.py, with echo as the program."""

import tempfile
import unittest
from pathlib import Path

from commands import Page, Wrong, matches


def run(text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.md"
        page.write_text(text, encoding="utf-8")
        place = Path(folder) / "run"
        place.mkdir()
        Page(page, Path("/bin/echo"), place, with_slow=False).run()


def says(command: str, output: str, info: str = "sh") -> str:
    return f"```{info}\n{command}\n```\n```text\n{output}\n```\n"


class Commands(unittest.TestCase):
    def test_that_print_what_is_said_are_right(self):
        run(says("pleuel mass   1.2345 kg", "mass 1.2345 kg"))
        run(says("pleuel a\npleuel b", "a\nb"))
        run(says("printf '1\\n2\\n3\\n4\\n'", "1\n…\n4"))

    def test_that_print_something_else_are_wrong(self):
        for output in ("mass 1.2360 kg", "mass 1.2345 g", "mass", "mass 1.2345 kg now"):
            with self.assertRaises(Wrong):
                run(says("pleuel mass 1.2345 kg", output))
        with self.assertRaises(Wrong):  # not one behind the other
            run(says("printf '1\\n2\\n3\\n'", "1\n3"))
        with self.assertRaises(Wrong):  # in another order
            run(says("printf '1\\n2\\n3\\n'", "3\n…\n1"))

    def test_must_end_with_the_code_that_is_said(self):
        run("```sh exit=3\nexit 3\n```\n")
        for text in ("```sh\nexit 3\n```\n", "```sh exit=3\ntrue\n```\n", "```sh exit=3\nexit 3\nexit 3\n```\n"):
            with self.assertRaises(Wrong):
                run(text)

    def test_marked_as_slow_or_by_hand_do_not_run(self):
        run("```sh slow\nfalse\n```\n```sh by hand\nfalse\n```\n```text\nnothing\n```\n")

    def test_see_the_files_of_the_page(self):
        run('```json a.json\n{"x": {"y": 1}}\n```\n```json a.json /x\n"z": 2\n```\n'
            + says("tr -d ' \\n' < a.json", '{"x":{"y":1,"z":2}}'))

    def test_see_a_mistake_once(self):
        run("```json a.json\n{}\n```\n```json a.json wrong\n{oops}\n```\n"
            + says("cat a.json", "{oops}") + says("cat a.json", "{}"))


class Lines(unittest.TestCase):
    def test_may_differ_in_spaces_and_slightly_in_numbers(self):
        self.assertTrue(matches("a   −1.0000  kg", "a −1.0005 kg"))
        self.assertFalse(matches("a 1.0000 kg", "a -1.0000 kg"))
        self.assertTrue(matches("mass … kg (…)", "mass 1.2 kg (−3 %)"))
        self.assertFalse(matches("mass … kg", "mass 1.2 g"))


if __name__ == "__main__":
    unittest.main()
