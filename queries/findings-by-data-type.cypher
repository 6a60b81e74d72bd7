// name: findings-by-data-type
// kind: table
// description: Which findings are of data that is represented in some way, such as video, audio or position?
// param type: string, image, video, audio, position or another data type; all of them if it is empty, default ""
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns type: string, how the data is represented
// returns robot: string, name of the robot
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns article9: string, strongest verdict under Article 9(1) GDPR
// order: type, robot, category, source, leak
MATCH (c:DataCategory)
UNWIND coalesce(c.data_types, []) AS type
WITH c, type WHERE $type = '' OR type = $type
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot
RETURN type, f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak, c.article9 AS article9
ORDER BY type, robot, category, source, leak
