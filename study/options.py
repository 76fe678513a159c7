# SPDX-License-Identifier: MIT
"""Methods, their presets and options, as the tool tells of them."""
from dataclasses import dataclass, field
from typing import Any

PRESETS = ("low", "medium", "high", "ultra", "paper")

# Integrals that a method does not choose by its option `falloff`: alchemy has a falloff of
# its own; vo and ssao are held to the nearest there is.
FALLOFFS = {"alchemy": "alchemy", "vo": "cubic", "ssao": "none"}


@dataclass(frozen=True)
class Target:
    """The integral that an estimate is held to."""
    weighting: str = "cosine"
    falloff: str = "none"
    definition: str = "hemisphere"

    @property
    def name(self) -> str:
        if self.definition == "tangent-sphere":
            return "tangent sphere"
        return f"{self.weighting}, {self.falloff}"

    def flags(self) -> list[str]:
        if self.definition != "hemisphere":
            return ["--definition", self.definition]
        return ["--weighting", self.weighting, "--falloff", self.falloff]


class Registry:
    """What `crevice methods --json` says."""

    def __init__(self, listing: dict[str, Any]):
        self.version: str = listing["version"]
        self.methods = {m["name"]: m for m in listing["methods"]}
        self.filters = [f["name"] for f in listing["filters"]]
        self.filter_options = {o["key"]: o["default"] for f in listing["filters"]
                               for o in f["options"]}

    def reads(self, method: str, key: str) -> bool:
        return any(o["key"] == key for o in self.methods[method]["options"])

    def preset(self, method: str, preset: str) -> dict[str, str]:
        text = self.methods[method]["presets"][preset]
        return dict(word.split("=", 1) for word in text.split())

    def default(self, method: str, key: str) -> Any:
        if key == "filter":
            return self.methods[method]["filter"]
        return next((o["default"] for o in self.methods[method]["options"]
                     if o["key"] == key), None)

    def options(self, method: str, preset: str = "medium", **settings: Any) -> "Options":
        return Options(self, method, preset).set(**settings)


@dataclass(frozen=True)
class Options:
    """A method, a preset, and what is set beyond it."""
    registry: Registry = field(compare=False, repr=False)
    method: str
    preset: str = "medium"
    settings: tuple[tuple[str, str], ...] = ()

    def set(self, **settings: Any) -> "Options":
        """The same with these settings. What the method does not read stays out."""
        kept = dict(self.settings)
        for key, value in settings.items():
            if key in ("filter", "exact", "radius", *self.registry.filter_options) or self.reads(key):
                kept[key] = f"{value:g}" if isinstance(value, float) else str(value)
        return Options(self.registry, self.method, self.preset, tuple(sorted(kept.items())))

    def reads(self, key: str) -> bool:
        return self.registry.reads(self.method, key)

    def has(self, key: str) -> bool:
        return key in dict(self.settings)

    def get(self, key: str) -> Any:
        """What holds: the setting, else the preset's, else the default."""
        if key in dict(self.settings):
            return dict(self.settings)[key]
        preset = self.registry.preset(self.method, self.preset)
        return preset.get(key, self.registry.default(self.method, key))

    def number(self, key: str) -> float:
        return float(self.get(key))

    def flags(self) -> list[str]:
        """Arguments of the tool but for the radius."""
        flags = ["--method", self.method, "--preset", self.preset]
        for key, value in self.settings:
            flags.append("--" + key.replace("_", "-"))
            if key != "exact":
                flags.append(value)
        return flags

    @property
    def samples(self) -> float:
        """Look-ups in the buffers for each pixel, at most."""
        if not self.reads("directions"):
            return self.number("samples")
        count = self.number("directions") * self.number("steps")
        if self.method == "hsao":
            return count * (1 + self.number("normal_rays"))
        return count * self.number("normal_rays") if self.reads("normal_rays") else count

    @property
    def target(self) -> Target:
        """The integral that these options estimate."""
        if self.method == "vao":
            return Target(definition="tangent-sphere")
        weighting = (self.get("weighting") if self.reads("weighting")
                     else self.registry.methods[self.method]["weighting"])
        falloff = self.get("falloff") if self.reads("falloff") else FALLOFFS[self.method]
        return Target("uniform" if weighting != "cosine" else "cosine", falloff)

    def much(self, samples: int) -> "Options":
        """Many samples and no filter: what the method converges to. One step of containment
        is another estimator, not a coarse one, and stays."""
        steps = {"steps": 24} if self.reads("steps") and self.number("steps") > 1 else {}
        return self.set(filter="none", noise_size=4, bands=1, samples=samples, directions=24,
                        **steps)
