"""python3 -m pleuel …: the program."""

import sys

from ._border import c_texts, library

words = ["python3 -m pleuel", *sys.argv[1:]]
sys.exit(library.pleuel_main(len(words), c_texts(words)))
