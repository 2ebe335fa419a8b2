"""make_headers.py TRACTION.XML C|Python OUT: the dialect in C (a folder of headers) or Python (one module), by pymavlink's generator."""
import os
import shutil
import sys
import tempfile

import pymavlink
from pymavlink.generator import mavgen

source, language, out = sys.argv[1:]
common = os.path.join(os.path.dirname(pymavlink.__file__), "dialects", "v20")
with tempfile.TemporaryDirectory() as folder:  # an included file is looked for beside the one that includes it
    for name in ("common.xml", "standard.xml", "minimal.xml"):
        shutil.copy(os.path.join(common, name), folder)
    shutil.copy(source, folder)
    os.makedirs(out if language == "C" else os.path.dirname(os.path.abspath(out)), exist_ok=True)
    options = mavgen.Opts(out, wire_protocol="2.0", language=language, validate=False, strict_units=False)
    if not mavgen.mavgen(options, [os.path.join(folder, os.path.basename(source))]):
        sys.exit("make_headers.py: pymavlink refused " + source)
