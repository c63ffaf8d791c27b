"""What the operator of a study does: declare, freeze, enrol, watch, withdraw."""
