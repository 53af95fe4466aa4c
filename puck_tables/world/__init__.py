"""Many pucks on one floor: from impact to impact along curves that are known, never in steps."""
