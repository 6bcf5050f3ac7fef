"""The codes of the tag family tag36h11, as crates/trundle-vision/data/tag36h11.txt: 587 codes of 36 bits, hexadecimal, ten a line.

usage: tag36h11.py > crates/trundle-vision/data/tag36h11.txt

The codes are those of [Olson11], read from the dictionary DICT_APRILTAG_36h11 of opencv-python-headless (PyPI). OpenCV stores each
tag turned by 180 degrees; this script turns it back. The first bit is the upper left cell, then row by row; 1 is white.
"""
import cv2
import numpy as np


def codes():
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    for i in range(dictionary.bytesList.shape[0]):
        cells = dictionary.getBitsFromByteList(dictionary.bytesList[i : i + 1], 6)
        bits = np.rot90(cells, 2).flatten()
        yield int("".join(str(int(bit)) for bit in bits), 2)


if __name__ == "__main__":
    words = [f"{code:09x}" for code in codes()]
    for i in range(0, len(words), 10):
        print(" ".join(words[i : i + 10]))
