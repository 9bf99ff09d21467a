"""The checksum CRC-24Q (RTCM 10403.3, 4.2; Galileo OS SIS ICD 2.1, 5.1.9.4), bit by bit."""


def crc24q(data):
    crc = 0
    for byte in data:
        crc ^= byte << 16
        for _ in range(8):
            crc = crc << 1 ^ (0x1864CFB if crc & 0x800000 else 0)
    return crc & 0xFFFFFF


def crc24q_of_bits(text):
    """Of zeros and ones as text; zeros in front, which fill up the first byte, change nothing."""
    return crc24q(int(text, 2).to_bytes((len(text) + 7) // 8, "big"))
