"""The figures of Biswas, Shapiro and Tsukanov: what each shows, and how ours is drawn.

A figure is added here alone: as a Figure in the Part of its section, and a section as a Part in
PARTS, both in the order of the paper. scripts/make_papers --only biswas_fig08 then draws it.
"""

from papers.paper import Figure, Part

CUTTER = "scenes/diamond_cutter.json"

SECTION_1 = Part(
    "Section 1: a cutting tool of two materials",
    f"[diamond_cutter.json](../../{CUTTER}): a chip of diamond on a shank, which at the prism "
    "under the chip is 20 % silicon carbide and 80 % diamond, at the block at its other end "
    "silicon carbide alone, and in between a mixture by the distances to both.",
    (
        Figure(
            "Figure 1",
            "(a) The tool with its chip, block, prism and the region in between. (b) The share of "
            "each material on the section through the middle: it changes linearly from prism to "
            "block, and both shares add up to 1.",
            (
                f"{CUTTER} --isosurface --resolution 96",
                f"{CUTTER} --section y=0 --fraction silicon_carbide diamond --outline prism block "
                "--columns 1",
            ),
            "Every size. The chip is a part of its own, of pure diamond. Exponent 1 at both "
            "features, which is linear along a straight line from one to the other.",
        ),
        Figure(
            "Figure 3",
            "The distances to prism and block on the same section, approximated so that the first "
            "two derivatives are those of the distance at the feature.",
            (
                f'{CUTTER} --section y=0 --field "=max(0, -prism)" "=max(0, -block)" --only inside '
                "--outline prism block --columns 1 --bands 0.5",
            ),
            "The exact distances, 0 within the feature; one scale for both; levels every 0.5. Both "
            "features go on through the tool's whole width.",
        ),
    ),
)

PARTS = {"section_1": SECTION_1}
