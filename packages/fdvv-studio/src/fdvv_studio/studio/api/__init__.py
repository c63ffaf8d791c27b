"""What each page of the studio asks of the server: messages and their handlers together."""
