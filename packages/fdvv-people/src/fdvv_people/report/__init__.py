"""How reports word statistics and draw scores."""
