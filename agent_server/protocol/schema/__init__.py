"""What is generated from the messages: schema, documents, and the clients' types."""
