"""sheet.py OUT.png < plan: small pictures in rows and columns, captioned, as one PNG of 256 colours.

The plan is JSON: {"columns": [caption, …], "rows": {caption: [PNG of each column]}}.
"""

import json
import sys

from PIL import Image, ImageDraw, ImageFont

MARGIN, LINE = 8, 22


def main(out):
    plan = json.load(sys.stdin)
    rows = {caption: [Image.open(path).convert("RGB") for path in paths] for caption, paths in plan["rows"].items()}
    width, height = next(iter(rows.values()))[0].size
    columns = plan["columns"]
    sheet = Image.new("RGB", (len(columns) * width, LINE + len(rows) * (height + LINE)), "white")
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(15)
    for x, caption in enumerate(columns):
        draw.text((x * width + MARGIN, 3), caption, "black", font)
    for y, (caption, pictures) in enumerate(rows.items()):
        top = LINE + y * (height + LINE)
        draw.text((MARGIN, top + 3), caption, "dimgray", font)
        for x, picture in enumerate(pictures):
            sheet.paste(picture, (x * width, top + LINE))
    sheet.quantize(256).save(out, optimize=True)


if __name__ == "__main__":
    main(sys.argv[1])
