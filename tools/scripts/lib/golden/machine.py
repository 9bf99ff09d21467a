"""The compiler of a program and the machine it runs on: only where both are the same are results equal bit for bit."""
import os
import platform
import re
import struct


class NoCompiler(Exception):
    pass


def is_elf(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


def comment_section(path):
    """The texts of an ELF file's section .comment, in which each compiler writes its name."""
    with open(path, "rb") as file:
        head = file.read(64)
        if head[:6] != b"\x7fELF\x02\x01":
            raise NoCompiler(f"{path}: no 64-bit little-endian ELF program")
        offset, = struct.unpack_from("<Q", head, 40)
        size, count, names = struct.unpack_from("<HHH", head, 58)
        file.seek(offset)
        sections = [struct.unpack_from("<IIQQQQ", file.read(size)) for _ in range(count)]

        def content(section):
            file.seek(section[4])
            return file.read(section[5])
        table = content(sections[names])
        for section in sections:
            if table[section[0]:table.index(b"\0", section[0])] == b".comment":
                return [text.decode(errors="replace") for text in content(section).split(b"\0") if text]
    return []


def compiler_of(program):
    """For example "gcc 12.2.0" or "clang 14.0.6". Programs that clang links contain start-up files of gcc too."""
    texts = comment_section(program)
    for text in texts:
        if found := re.search(r"clang version (\d+\.\d+\.\d+)", text):
            return f"clang {found[1]}"
    for text in texts:
        if found := re.match(r"GCC: .*?(\d+\.\d+\.\d+)$", text):
            return f"gcc {found[1]}"
    raise NoCompiler(f"{program}: its section .comment names neither gcc nor clang: {texts or 'it is not there'}")


def compiler_of_all(folder, programs):
    """The one compiler of all programs that exist; scripts in the place of programs are ignored."""
    found = {}
    for program in programs:
        path = os.path.join(folder, program)
        if os.path.exists(path) and is_elf(path):
            found.setdefault(compiler_of(path), program)
    if not found:
        raise NoCompiler(f"{folder} holds none of leonav's programs")
    if len(found) > 1:
        raise NoCompiler(f"{folder} mixes compilers: " + ", ".join(f"{p} is of {c}" for c, p in sorted(found.items())))
    return next(iter(found))


def machine():
    """Properties that results of the C library's functions depend on; with FMA they run other code."""
    flags = ""
    try:
        with open("/proc/cpuinfo") as file:
            flags = next((line for line in file if line.startswith("flags")), "")
    except OSError:
        pass
    return {"processor": platform.machine(), "libc": " ".join(platform.libc_ver()), "fma": " fma " in f" {flags.strip()} ",
            "avx2": " avx2 " in f" {flags.strip()} "}


def differences(recorded, here):
    return [f"{key} {recorded.get(key)} then, {here[key]} now" for key in here if recorded.get(key) != here[key]]


