"""Damage to the bytes of a file, as disks, transfers and editors do it."""


def mutated(content, chance):
    """Return the bytes with one kind of damage; half of it hits the beginning, where tables are.

    Parameters
    ----------
    content : bytes
        The file.
    chance : random.Random
        What chooses.
    """
    changed, size = bytearray(content), len(content)
    ends = [size if chance.random() < 0.5 else min(size, 12_000) for _ in range(2)]
    place, other = (chance.randrange(end) for end in ends)
    length = chance.choice([1, 2, 4, 8, 64, 512, 4096])
    match chance.randrange(8):
        case 0:
            changed[place] ^= 1 << chance.randrange(8)
        case 1:
            for _ in range(chance.randrange(1, 20)):
                changed[chance.randrange(ends[0])] = chance.randrange(256)
        case 2:
            changed[place : place + length] = bytes(len(changed[place : place + length]))
        case 3:
            changed[place : place + 8] = b"\xff" * len(changed[place : place + 8])
        case 4:
            del changed[chance.randrange(size) :]
        case 5:
            del changed[place : place + length]
        case 6:
            changed[place : place + length] = changed[other : other + length]
        case _:
            number = chance.choice([0, 1, 1000, 2**31, 2**40, 2**62, 2**63 - 1])
            changed[place : place + 8] = number.to_bytes(8, "little")
    return bytes(changed)
