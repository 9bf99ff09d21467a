"""The types that lcm-gen writes for Python, as an encoder of messages that shares nothing with leonav's decoders."""
import re
import subprocess
import sys


def generated_types(root, folder):
    """Writes them into a folder and imports them, under a name of their own because their package is called as leonav's."""
    subprocess.run(["lcm-gen", "-p", "--ppath", folder, *sorted((root / "lcmtypes").glob("*.lcm"))], check=True)
    (folder / "leonav").rename(folder / "generated_leonav")
    for file in (folder / "generated_leonav").glob("*.py"):
        file.write_text(re.sub(r"\bleonav\.", "generated_leonav.", file.read_text()))
    sys.path.insert(0, str(folder))
    import generated_leonav
    return generated_leonav
