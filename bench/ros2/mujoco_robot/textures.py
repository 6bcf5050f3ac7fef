"""Pictures on walls, floors and furniture, drawn from a seed. Every texture has corners that a feature detector finds."""
import io

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

# Edge of a surface texture, px; it covers TILE_M of surface.
SIZE_PX = 512
# Edge of the surface that one texture covers, m: about 4 mm a pixel.
TILE_M = 2.0


def encode(image):
    """PNG bytes; MuJoCo reads the first row as the top."""
    buffer = io.BytesIO()
    image.convert("RGB").save(buffer, "PNG", compress_level=1)
    return buffer.getvalue()


def color(rng, low=40, high=230):
    return tuple(int(c) for c in rng.integers(low, high, 3))


def grain(image, rng, amount):
    """White noise of `amount` grey levels on every pixel."""
    pixels = np.asarray(image, np.int16) + rng.normal(0, amount, (image.height, image.width, 1)).astype(np.int16)
    return Image.fromarray(pixels.clip(0, 255).astype(np.uint8))


def poster(rng):
    """A picture of rectangles, ellipses and lines of text-like marks."""
    image = Image.new("RGB", (384, 256), color(rng, 120, 250))
    draw = ImageDraw.Draw(image)
    for _ in range(int(rng.integers(10, 18))):
        x, y = rng.integers(0, 340), rng.integers(0, 220)
        w, h = rng.integers(15, 140), rng.integers(12, 90)
        shape = draw.rectangle if rng.random() < 0.6 else draw.ellipse
        shape([x, y, x + w, y + h], fill=color(rng, 10, 255), outline=color(rng, 0, 90), width=2)
    for line in range(int(rng.integers(2, 6))):
        x, y = int(rng.integers(8, 120)), 14 + 40 * line
        for _ in range(int(rng.integers(8, 24))):
            w = int(rng.integers(3, 12))
            draw.rectangle([x, y, x + w, y + int(rng.integers(6, 12))], fill=(20, 20, 30))
            x += w + 4
    draw.rectangle([0, 0, 383, 255], outline=color(rng, 0, 60), width=7)
    return image


def wallpaper(rng):
    """A light wall with irregular prints."""
    base = color(rng, 165, 215)
    image = Image.new("RGB", (SIZE_PX, SIZE_PX), base)
    draw = ImageDraw.Draw(image)
    for _ in range(260):
        x, y = rng.integers(0, SIZE_PX, 2)
        r = int(rng.integers(2, 11))
        shade = tuple(int(np.clip(c + rng.integers(-70, 35), 0, 255)) for c in base)
        points = [(x + r * np.cos(a), y + r * np.sin(a)) for a in np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 7))))]
        draw.polygon(points, fill=shade)
    return grain(image, rng, 4)


def planks(rng):
    """A floor of boards with knots."""
    image = Image.new("RGB", (SIZE_PX, SIZE_PX))
    draw = ImageDraw.Draw(image)
    for row in range(0, SIZE_PX, 32):
        x = -int(rng.integers(0, 120))
        while x < SIZE_PX:
            length = int(rng.integers(110, 260))
            tone = int(rng.integers(-26, 26))
            draw.rectangle([x, row, x + length, row + 31], fill=(150 + tone, 112 + tone, 74 + tone), outline=(84, 58, 36))
            for _ in range(int(rng.integers(1, 4))):
                kx, ky, r = x + rng.integers(5, length), row + rng.integers(4, 28), int(rng.integers(1, 5))
                draw.ellipse([kx - 2 * r, ky - r, kx + 2 * r, ky + r], fill=(96 + tone, 66 + tone, 40 + tone))
            x += length
    return grain(image, rng, 6)


def panels(rng):
    """A ceiling of mineral tiles."""
    image = Image.new("RGB", (SIZE_PX, SIZE_PX), (214, 214, 208))
    draw = ImageDraw.Draw(image)
    for _ in range(500):
        x, y = rng.integers(0, SIZE_PX, 2)
        draw.ellipse([x, y, x + rng.integers(1, 4), y + rng.integers(1, 4)], fill=(150, 150, 146))
    for line in range(0, SIZE_PX, 128):
        draw.line([0, line, SIZE_PX, line], fill=(168, 168, 165), width=3)
        draw.line([line, 0, line, SIZE_PX], fill=(168, 168, 165), width=3)
    return image


def cloth(rng):
    """Fabric with an irregular print."""
    image = Image.new("RGB", (SIZE_PX, SIZE_PX), color(rng, 60, 160))
    draw = ImageDraw.Draw(image)
    for _ in range(420):
        x, y = rng.integers(0, SIZE_PX, 2)
        s = int(rng.integers(4, 18))
        draw.rectangle([x, y, x + s, y + int(rng.integers(4, 18))], fill=color(rng, 40, 220))
    return grain(image.filter(ImageFilter.GaussianBlur(1)), rng, 6)


def shelf(rng):
    """Books or boxes side by side."""
    image = Image.new("RGB", (SIZE_PX, SIZE_PX), (92, 66, 44))
    draw = ImageDraw.Draw(image)
    for row in range(0, SIZE_PX, 90):
        x = 4
        while x < SIZE_PX - 12:
            w, h = int(rng.integers(7, 20)), int(rng.integers(50, 78))
            draw.rectangle([x, row + 84 - h, x + w, row + 84], fill=color(rng, 20, 235), outline=(24, 20, 18))
            draw.rectangle([x + 2, row + 90 - h, x + w - 2, row + 96 - h], fill=color(rng, 150, 255))
            x += w + int(rng.integers(1, 5))
    return image


def wood(rng):
    """Furniture board with printed labels."""
    tone = int(rng.integers(-30, 40))
    image = Image.new("RGB", (SIZE_PX, SIZE_PX), (140 + tone, 104 + tone, 70 + tone))
    draw = ImageDraw.Draw(image)
    for _ in range(160):
        x, y = rng.integers(0, SIZE_PX, 2)
        draw.line([x, y, x + int(rng.integers(20, 120)), y + int(rng.integers(-3, 3))], fill=(110 + tone, 78 + tone, 50 + tone), width=2)
    for _ in range(140):
        x, y = rng.integers(0, SIZE_PX, 2)
        draw.rectangle([x, y, x + int(rng.integers(3, 20)), y + int(rng.integers(3, 12))], fill=color(rng, 30, 250))
    return grain(image, rng, 5)


KINDS = {"wallpaper": wallpaper, "planks": planks, "panels": panels, "cloth": cloth, "shelf": shelf, "wood": wood, "poster": poster}
