"""Pictures: one module a kind of result, all in one style."""
