"""Long work: many independent items, in memory or in a store, by threads or by a cluster."""
