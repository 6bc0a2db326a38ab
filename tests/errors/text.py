import optixc as ox

NAME = "gradient"


@ox.program
def __raygen__a():
    """Text in docstrings and prints is fine."""
    print("fine", 1, f"x = {1 + 1}", sep=", ", end="\n")
    s = "text"  # E[OX403]: text is not a value in shaders
    t = f"{1}"  # E[OX403]: an f-string outside of print()
    u = NAME  # E[OX310]: it is text
    print(f"{1:03d}")  # E[OX403]: format specifications
    print(1, file=2)  # E[OX305]: print() has no parameter `file`
    print(1, sep=3)  # E[OX403]: must be plain text
    x = print(1)  # E[OX402]: print() gives no value
    assert 1 < 2, "fine"
    assert 1 < 2, 3  # E[OX403]: the message of an assert must be plain text
    v = b"bytes"  # E[OX403]: text is not a value
