"""Files: atomic writes, versioned JSON documents, columns, Parquet parts, file kinds."""
