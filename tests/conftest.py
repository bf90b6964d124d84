"""Random examples are the same in every run, and may take as long as the machine makes them."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

settings.register_profile("magshell", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("magshell")
