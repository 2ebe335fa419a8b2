"""jffs2_list.py IMAGE ERASE_BYTES - reads a JFFS2 image as the scan of Linux does, node by node, and lists it.

Every node's CRCs are checked, by zlib's CRC-32 turned into JFFS2's; a node that crosses an erase block, a block without its cleanmarker, a
byte between nodes that is not erased, an entry without its file or a file without all of its bytes ends with 1 and words. Lists, a line each:
octal mode with its type, owner, size [byte], SHA-256 (a device: its number), path.
"""
import hashlib
import struct
import sys
import zlib

CLEANMARKER, DIRENT, INODE = 0x2003, 0xE001, 0xE002


def crc(data: bytes) -> int:
    """JFFS2 begins with 0 and does not invert; zlib begins with all ones and inverts."""
    return (zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF) & 0xFFFFFFFF


def nodes(image: bytes, erase: int):
    assert image and len(image) % erase == 0, f"{len(image)} bytes are no whole erase blocks"
    for block in range(0, len(image), erase):
        at, end = block, block + erase
        while at < end:
            if image[at : at + 4] == b"\xff" * 4:
                at += 4
                assert image[at:end].strip(b"\xff") == b"", f"something lies behind erased bytes of the block at {block:#x}"
                break
            magic, kind, length, check = struct.unpack_from("<HHII", image, at)
            assert magic == 0x1985 and check == crc(image[at : at + 8]), f"no node at {at:#x}"
            assert (kind == CLEANMARKER) == (at == block), f"cleanmarker at {at:#x}"
            assert at + length <= end, f"the node at {at:#x} crosses its erase block"
            yield kind, image[at : at + length]
            padded = (length + 3) & ~3
            assert image[at + length : at + padded].strip(b"\xff") == b"", f"padding at {at + length:#x}"
            at += padded


def main() -> None:
    image = open(sys.argv[1], "rb").read()
    entries: dict[int, tuple[int, int, str]] = {}
    files: dict[int, dict] = {}
    versions = set()
    for kind, node in nodes(image, int(sys.argv[2])):
        if kind == DIRENT:
            parent, version, number, _, size, form, _, node_crc, name_crc = struct.unpack_from("<IIIIBBHII", node, 12)
            name = node[40:]
            assert node_crc == crc(node[:32]) and name_crc == crc(name) and len(name) == size, f"entry {name!r}"
            assert (parent, version) not in versions and number not in entries, f"entry {name!r} twice"
            versions.add((parent, version))
            entries[number] = (parent, form, name.decode())
        elif kind == INODE:
            number, version, mode, user, group, size, _, _, _, offset, stored, length, packed, _, _, data_crc, node_crc = struct.unpack_from(
                "<IIIHHIIIIIIIBBHII", node, 12
            )
            data = node[68:]
            assert node_crc == crc(node[:60]) and data_crc == crc(data), f"file {number}"
            assert packed == 0 and stored == length == len(data) <= 4096 and offset % 4096 == 0, f"file {number}"
            assert (number, version) not in versions, f"file {number}"
            versions.add((number, version))
            file = files.setdefault(number, {"mode": mode, "owner": (user, group), "size": size, "data": {}})
            assert (file["mode"], file["owner"], file["size"]) == (mode, (user, group), size)
            file["data"][offset] = data
    assert set(files) == set(entries) | {1}, "entries and files"

    def path(number: int) -> str:
        parent, _, name = entries[number]
        return name if parent == 1 else f"{path(parent)}/{name}"

    for number in sorted(entries, key=path):
        file = files[number]
        data = b"".join(part for _, part in sorted(file["data"].items()))
        assert len(data) == file["size"] and all(file["data"].get(at) is not None for at in range(0, len(data), 4096)), path(number)
        assert file["mode"] >> 12 == entries[number][1], f"type of {path(number)}"
        device = file["mode"] >> 12 in (2, 6)
        words = f"{data[1]},{data[0]}" if device else hashlib.sha256(data).hexdigest()
        print(f"{file['mode']:06o} {file['owner'][0]}:{file['owner'][1]} {file['size']} {words} {path(number)}")


try:
    main()
except AssertionError as wrong:
    sys.exit(f"jffs2_list: {sys.argv[1]}: {wrong}")
